#pragma once

#include <string>
#include <string_view>

namespace isotherm::apps {

/// `text` as XML and HTML may hold it between tags. Control characters become blanks; what is
/// not UTF-8, as names of files need not be, and what XML has no place for becomes U+FFFD.
std::string xml_text(std::string_view text);

}  // namespace isotherm::apps
