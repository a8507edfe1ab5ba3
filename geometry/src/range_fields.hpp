#pragma once

#include "isotherm/base/text_reader.hpp"

namespace isotherm::geometry {

/// Goes to the next line that is neither empty nor a comment.
bool next_content_line(TextReader& text);

/// The next token as a distance. @throws ParseError unless it is one
double distance_field(TextReader& text);

}  // namespace isotherm::geometry
