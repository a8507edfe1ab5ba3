#include "arrays.hpp"

#include <filesystem>

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>

namespace isotherm::python {
namespace {

template <class T>
constexpr const char* kTypeName = "float64";
template <>
constexpr const char* kTypeName<std::int32_t> = "int32";
template <>
constexpr const char* kTypeName<std::int64_t> = "int64";
template <>
constexpr const char* kTypeName<std::uint64_t> = "uint64";

std::string shape_text(std::initializer_list<std::int64_t> shape) {
  std::string text = "(";
  for (const auto length : shape) {
    if (text.size() > 1) text += ", ";
    text += length == kAny ? "n" : std::to_string(length);
  }
  return text + (shape.size() == 1 ? ",)" : ")");
}

std::string text_of(nb::handle value) { return nb::cast<std::string>(nb::str(value)); }

template <class T>
void require_kind(nb::handle array, std::string_view what) {
  const auto kind = nb::cast<std::string>(array.attr("dtype").attr("kind"));
  const bool integer = kind == "i" || kind == "u";
  if (integer || (std::floating_point<T> && kind == "f")) return;
  const std::string wanted = std::floating_point<T> ? "numbers" : "integers";
  throw nb::type_error((std::string(what) + ": expected " + wanted + ", got an array of " +
                        text_of(array.attr("dtype")))
                           .c_str());
}

void require_shape(nb::handle array, std::string_view what,
                   std::initializer_list<std::int64_t> shape) {
  const auto given = nb::cast<nb::tuple>(array.attr("shape"));
  bool fits = given.size() == shape.size();
  std::size_t axis = 0;
  for (const auto length : shape) {
    fits = fits && (length == kAny || nb::cast<std::int64_t>(given[axis]) == length);
    ++axis;
  }
  if (fits) return;
  throw nb::value_error((std::string(what) + ": expected an array of shape " + shape_text(shape) +
                         ", got " + text_of(given))
                            .c_str());
}

// NumPy would wrap them.
void require_representable(nb::handle array, std::string_view what, const char* type) {
  const nb::module_ numpy = nb::module_::import_("numpy");
  if (numpy.attr("can_cast")(array.attr("dtype"), type).is(nb::bool_(true))) return;
  const nb::object limits = numpy.attr("iinfo")(type);
  const bool below = array.attr("min")() < limits.attr("min");
  const bool above = array.attr("max")() > limits.attr("max");
  if (!below && !above) return;
  throw nb::value_error((std::string(what) + ": a number does not fit into " + type).c_str());
}

}  // namespace

template <class T>
Input<T> numbers(nb::handle value, std::string_view what,
                 std::initializer_list<std::int64_t> shape) {
  const nb::module_ numpy = nb::module_::import_("numpy");
  nb::object array = numpy.attr("asarray")(value);
  const bool nothing = nb::cast<std::int64_t>(array.attr("size")) == 0;
  if (!nothing) require_kind<T>(array, what);
  // A list of nothing has one axis, and a type that says nothing.
  if (nothing && *shape.begin() == kAny && nb::cast<int>(array.attr("ndim")) == 1) {
    nb::list lengths;
    for (const auto length : shape) lengths.append(length == kAny ? 0 : length);
    array = numpy.attr("zeros")(nb::tuple(lengths));
  }
  require_shape(array, what, shape);
  if (std::integral<T> && !nothing) require_representable(array, what, kTypeName<T>);
  array = numpy.attr("ascontiguousarray")(array, kTypeName<T>);
  return nb::cast<Input<T>>(array);
}

template Input<double> numbers(nb::handle, std::string_view, std::initializer_list<std::int64_t>);
template Input<std::int32_t> numbers(nb::handle, std::string_view,
                                     std::initializer_list<std::int64_t>);
template Input<std::int64_t> numbers(nb::handle, std::string_view,
                                     std::initializer_list<std::int64_t>);
template Input<std::uint64_t> numbers(nb::handle, std::string_view,
                                      std::initializer_list<std::int64_t>);

void require_length(std::string_view what, std::size_t got, std::size_t expected) {
  if (got == expected) return;
  throw nb::value_error((std::string(what) + ": expected " + std::to_string(expected) +
                         " rows, got " + std::to_string(got))
                            .c_str());
}

Eigen::MatrixXd columns_of(nb::handle rows, std::string_view what, std::int64_t dimension) {
  const auto array = numbers<double>(rows, what, {kAny, dimension});
  return Eigen::Map<const Eigen::MatrixXd>(array.data(), static_cast<Eigen::Index>(array.shape(1)),
                                           static_cast<Eigen::Index>(array.shape(0)));
}

nb::object data_frame(const nb::dict& columns) {
  nb::object pandas;
  try {
    pandas = nb::module_::import_("pandas");
  } catch (const nb::python_error& error) {
    if (!error.matches(PyExc_ImportError)) throw;
    throw nb::import_error("to_dataframe() needs pandas: pip install 'isotherm[pandas]'");
  }
  return pandas.attr("DataFrame")(columns);
}

std::string path_of(nb::handle path) {
  PyObject* bytes = nullptr;
  if (PyUnicode_FSConverter(path.ptr(), &bytes) == 0) throw nb::python_error();
  const nb::object kept = nb::steal(bytes);
  return std::string(PyBytes_AS_STRING(bytes), static_cast<std::size_t>(PyBytes_GET_SIZE(bytes)));
}

}  // namespace isotherm::python
