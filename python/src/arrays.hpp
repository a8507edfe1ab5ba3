#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <Eigen/Core>

namespace isotherm::python {

namespace nb = nanobind;

/// Any number of rows, where a shape is stated.
inline constexpr std::int64_t kAny = -1;

/// An array of ours as Python sees it: nothing is copied, and nothing can be written.
template <class T, class... Shape>
using View = nb::ndarray<nb::numpy, const T, Shape..., nb::ro>;
template <class T>
using View1 = View<T, nb::shape<-1>>;
template <class T>
using View2 = View<T, nb::shape<-1, -1>>;

/// Numbers that Python gave, row-major and without gaps: its own memory where that is so
/// already and of the type asked for, else a copy.
template <class T>
using Input = nb::ndarray<const T, nb::c_contig, nb::device::cpu>;

/// `value` as numbers of this shape (kAny: any length); `what` names it in messages. Nothing at
/// all has any shape that may be empty. Integers are taken from integers only.
/// @throws TypeError or ValueError, which say what was expected and what was given
template <class T>
Input<T> numbers(nb::handle value, std::string_view what,
                 std::initializer_list<std::int64_t> shape);

extern template Input<double> numbers(nb::handle, std::string_view,
                                      std::initializer_list<std::int64_t>);
extern template Input<std::int32_t> numbers(nb::handle, std::string_view,
                                            std::initializer_list<std::int64_t>);
extern template Input<std::int64_t> numbers(nb::handle, std::string_view,
                                            std::initializer_list<std::int64_t>);
extern template Input<std::uint64_t> numbers(nb::handle, std::string_view,
                                             std::initializer_list<std::int64_t>);

/// @throws ValueError unless `got` is the length that `what` must have
void require_length(std::string_view what, std::size_t got, std::size_t expected);

/// `value` as a vector of numbers.
template <class T>
std::vector<T> number_list(nb::handle value, std::string_view what) {
  const auto array = numbers<T>(value, what, {kAny});
  return std::vector<T>(array.data(), array.data() + array.size());
}

/// One row a point, as the columns that the library has: the same memory, seen otherwise.
Eigen::MatrixXd columns_of(nb::handle rows, std::string_view what, std::int64_t dimension = kAny);

/// Numbers with a stride, in bytes, between each two; `owner` keeps them alive.
template <class T>
View1<T> strided_view(const T* first, std::size_t count, std::size_t stride, nb::handle owner) {
  const std::int64_t steps[] = {static_cast<std::int64_t>(stride / sizeof(T))};
  return View1<T>(first, {count}, owner, {steps[0]});
}

/// `columns` numbers that stand beside each other, with a stride in bytes between each two rows.
template <class T>
View2<T> strided_rows(const T* first, std::size_t rows, std::size_t columns, std::size_t stride,
                      nb::handle owner) {
  return View2<T>(first, {rows, columns}, owner,
                  {static_cast<std::int64_t>(stride / sizeof(T)), 1});
}

template <class T>
View1<T> view(const std::vector<T>& values, nb::handle owner) {
  return strided_view(values.data(), values.size(), sizeof(T), owner);
}
inline View1<double> view(const Eigen::VectorXd& values, nb::handle owner) {
  return strided_view(values.data(), static_cast<std::size_t>(values.size()), sizeof(double),
                      owner);
}

/// A matrix as it is.
inline View2<double> view(const Eigen::MatrixXd& matrix, nb::handle owner) {
  const auto rows = static_cast<std::size_t>(matrix.rows());
  const auto columns = static_cast<std::size_t>(matrix.cols());
  return View2<double>(matrix.data(), {rows, columns}, owner, {1, matrix.rows()});
}

/// A matrix with one column a point, as one row a point.
inline View2<double> rows_of(const Eigen::MatrixXd& columns, nb::handle owner) {
  const auto dimension = static_cast<std::size_t>(columns.rows());
  return strided_rows(columns.data(), static_cast<std::size_t>(columns.cols()), dimension,
                      dimension * sizeof(double), owner);
}

/// Gives an array that was just made to Python.
template <class T, class... Shape>
nb::ndarray<nb::numpy, T, Shape...> give(std::vector<T> values,
                                         std::initializer_list<std::size_t> shape) {
  auto* const kept = new std::vector<T>(std::move(values));
  nb::capsule owner(kept,
                    [](void* memory) noexcept { delete static_cast<std::vector<T>*>(memory); });
  return nb::ndarray<nb::numpy, T, Shape...>(kept->data(), shape, owner);
}
template <class T>
nb::ndarray<nb::numpy, T, nb::shape<-1>> give(std::vector<T> values) {
  const std::size_t size = values.size();
  return give<T, nb::shape<-1>>(std::move(values), {size});
}
inline nb::ndarray<nb::numpy, double, nb::shape<-1, -1>> give(Eigen::MatrixXd matrix) {
  auto* const kept = new Eigen::MatrixXd(std::move(matrix));
  nb::capsule owner(kept,
                    [](void* memory) noexcept { delete static_cast<Eigen::MatrixXd*>(memory); });
  const auto rows = static_cast<std::size_t>(kept->rows());
  const auto columns = static_cast<std::size_t>(kept->cols());
  return {kept->data(), {rows, columns}, owner, {1, kept->rows()}};
}

/// A table of columns by name. @throws ImportError, which says what to install, without pandas
nb::object data_frame(const nb::dict& columns);

/// Gives a class to_dataframe(), which `frame` makes and whose columns are `contents`.
template <class Class, class Frame>
void bind_data_frame(nb::class_<Class>& bound, Frame frame, const std::string& contents) {
  bound.def("to_dataframe", frame, nb::sig("def to_dataframe(self) -> pandas.DataFrame"),
            (contents + ", as a table of pandas.").c_str());
}

/// What os.fspath() makes of `path`. @throws TypeError
std::string path_of(nb::handle path);

}  // namespace isotherm::python
