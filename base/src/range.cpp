#include "isotherm/base/range.hpp"

#include "isotherm/base/text_writer.hpp"

namespace isotherm {

std::string to_string(const Range& range) {
  return (range.has_low ? "[" : "(") + format_number(range.low) + ", " + format_number(range.high) +
         (range.has_high ? "]" : ")");
}

void require_in_range(std::string_view option, double value, const Range& range) {
  if (range.contains(value)) return;
  throw InvalidArgument(std::string(option), "must be in " + to_string(range));
}

void require_in_range(std::string_view option, const std::vector<double>& values,
                      const Range& range) {
  if (values.empty() && !range.may_be_none) {
    throw InvalidArgument(std::string(option), "must not be empty");
  }
  for (const double value : values) require_in_range(option, value, range);
}

}  // namespace isotherm
