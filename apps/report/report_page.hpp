#pragma once

#include <string>

#include "option_flags.hpp"

namespace isotherm::apps {

/// One self-contained HTML page that shows `document`. No text in the document can
/// end the element that holds it or run as script: every `<` is escaped.
std::string report_page(const Json& document);

/// The document on one line; bytes that are not UTF-8 are replaced.
std::string report_text(const Json& document);

}  // namespace isotherm::apps
