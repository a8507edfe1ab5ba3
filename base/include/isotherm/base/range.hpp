#pragma once

#include <cmath>
#include <concepts>
#include <string>
#include <string_view>
#include <vector>

#include "isotherm/base/error.hpp"

/// The values that numeric options may take. An option's field states its range where
/// visit_fields lists it; validation, help and configuration files all go by that.
namespace isotherm {

/// The finite numbers between two ends, each of which belongs to the range or not.
struct Range {
  double low = 0.0;
  double high = 0.0;
  bool has_low = true;
  bool has_high = true;
  bool may_be_none = false;  ///< of a list: that there is no value

  bool contains(double value) const noexcept {
    return std::isfinite(value) && (has_low ? value >= low : value > low) &&
           (has_high ? value <= high : value < high);
  }
};

constexpr Range closed(double low, double high) { return {low, high, true, true}; }
constexpr Range open(double low, double high) { return {low, high, false, false}; }
constexpr Range left_open(double low, double high) { return {low, high, false, true}; }
constexpr Range right_open(double low, double high) { return {low, high, true, false}; }

/// Of a list that may be empty.
constexpr Range or_none(Range range) {
  range.may_be_none = true;
  return range;
}

/// As mathematics writes it: "[0, 1)".
std::string to_string(const Range& range);

/// @throws InvalidArgument naming `option` unless `value` is in the range
void require_in_range(std::string_view option, double value, const Range& range);
template <std::integral Integer>
void require_in_range(std::string_view option, Integer value, const Range& range) {
  require_in_range(option, static_cast<double>(value), range);
}

/// @throws InvalidArgument if one of the values is outside the range, or if there are none where
/// the range asks for some
void require_in_range(std::string_view option, const std::vector<double>& values,
                      const Range& range);

/// @throws InvalidArgument naming the first field of `options` that is outside its range
template <class Options>
void require_fields_in_range(const Options& options) {
  visit_fields(options, []([[maybe_unused]] std::string_view name,
                           [[maybe_unused]] const auto& value, std::string_view,
                           const auto&... range) { (require_in_range(name, value, range), ...); });
}

}  // namespace isotherm
