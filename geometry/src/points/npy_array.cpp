#include "points/npy_array.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include "isotherm/base/error.hpp"
#include "isotherm/base/text_reader.hpp"

namespace isotherm::geometry::detail {
namespace {

static_assert(std::endian::native == std::endian::little);

class NpyReader {
 public:
  NpyReader(const std::string& path, std::string_view bytes) : path_(path), bytes_(bytes) {}

  Eigen::MatrixXd run() {
    const auto header = take_header();
    const auto type = text_of(header, "'descr':");
    const bool by_columns = rest_of(header, "'fortran_order':").starts_with("True");
    const auto [rows, columns] = shape_of(header);
    if (type == "<f8") return values<double>(rows, columns, by_columns);
    if (type == "<f4") return values<float>(rows, columns, by_columns);
    if (type == "<i8") return values<std::int64_t>(rows, columns, by_columns);
    if (type == "<i4") return values<std::int32_t>(rows, columns, by_columns);
    fail("expected little-endian floats or integers of 4 or 8 bytes", std::string(type));
  }

 private:
  [[noreturn]] void fail(const std::string& problem, const std::string& token = "") const {
    throw ParseError({path_, 0, 0}, token, "NumPy array: " + problem);
  }

  std::string_view take(std::size_t count) {
    if (bytes_.size() < count) fail("the file ends early");
    const auto taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }

  // The version decides how many bytes say how long the header is.
  std::string_view take_header() {
    take(kNpyMagic.size());
    const auto version = take(2);
    const std::size_t width = version[0] == 1 ? 2 : 4;
    std::uint32_t length = 0;
    std::memcpy(&length, take(width).data(), width);
    return take(length);
  }

  std::string_view rest_of(std::string_view header, std::string_view key) const {
    const auto found = header.find(key);
    if (found == std::string_view::npos) fail("no " + std::string(key) + " in its header");
    header.remove_prefix(found + key.size());
    header.remove_prefix(std::min(header.find_first_not_of(' '), header.size()));
    return header;
  }

  std::string_view text_of(std::string_view header, std::string_view key) const {
    auto rest = rest_of(header, key);
    if (!rest.starts_with('\'')) fail("expected a type after " + std::string(key));
    rest.remove_prefix(1);
    return rest.substr(0, rest.find('\''));
  }

  std::pair<Eigen::Index, Eigen::Index> shape_of(std::string_view header) const {
    const auto rest = rest_of(header, "'shape':");
    const auto shape = rest.substr(0, rest.find(')'));
    const auto axes = split(shape, "(, ");
    std::uint64_t rows = 0;
    std::uint64_t columns = 0;
    if (axes.size() != 2 || !parse_unsigned(axes[0], rows) || !parse_unsigned(axes[1], columns)) {
      fail("expected two axes, points and coordinates", std::string(shape) + ")");
    }
    if (rows == 0 || columns == 0) fail("it is empty");
    const std::uint64_t most = bytes_.size() / 4 + 1;
    if (rows > most || columns > most) fail("the file ends early");
    return {static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns)};
  }

  template <class Number>
  Eigen::MatrixXd values(Eigen::Index rows, Eigen::Index columns, bool by_columns) {
    const auto count = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
    if (bytes_.size() / sizeof(Number) != count || bytes_.size() % sizeof(Number) != 0) {
      fail("has " + std::to_string(bytes_.size()) + " bytes of numbers, expected " +
           std::to_string(count * sizeof(Number)));
    }
    std::vector<Number> numbers(count);
    std::memcpy(numbers.data(), bytes_.data(), bytes_.size());
    using Matrix = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic>;
    Eigen::MatrixXd all;
    if (by_columns) {
      all = Eigen::Map<const Matrix>(numbers.data(), rows, columns).template cast<double>();
    } else {
      all = Eigen::Map<const Matrix>(numbers.data(), columns, rows)
                .transpose()
                .template cast<double>();
    }
    if (!all.allFinite()) fail("holds a number that is not finite");
    return all;
  }

  const std::string& path_;
  std::string_view bytes_;
};

}  // namespace

Eigen::MatrixXd read_npy(const std::string& path, std::string_view bytes) {
  return NpyReader(path, bytes).run();
}

}  // namespace isotherm::geometry::detail
