#pragma once

#include "isotherm/base/text_reader.hpp"
#include "isotherm/network/range_network.hpp"

namespace isotherm::network::detail {

/// Goes to the next line that is neither empty nor a comment.
bool next_content_line(TextReader& text);

/// @throws ParseError at the last token, the second end of a range, if that is the first one again.
void require_other_end(TextReader& text, const RangeMeasurement& range);

/// The next token as a distance. @throws ParseError unless it is one
double distance_field(TextReader& text);

}  // namespace isotherm::network::detail
