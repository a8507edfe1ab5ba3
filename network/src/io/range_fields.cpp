#include "io/range_fields.hpp"

namespace isotherm::network::detail {

bool next_content_line(TextReader& text) {
  while (text.next_line()) {
    if (!text.at_line_end() && !text.line().starts_with('#')) return true;
  }
  return false;
}

void require_other_end(TextReader& text, const RangeMeasurement& range) {
  if (range.from == range.to) text.fail("expected another node than the first");
}

double distance_field(TextReader& text) {
  const double distance = text.number("a distance");
  if (distance < 0.0) text.fail("expected a distance >= 0");
  return distance;
}

}  // namespace isotherm::network::detail
