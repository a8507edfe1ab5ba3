#include "report/report_page.hpp"

#include <stdexcept>
#include <string_view>

#include "report/report_template.hpp"

namespace isotherm::apps {
namespace {

// Stands in the template where the document goes; viewer/src/index.html has it too.
constexpr std::string_view kPlaceholder = "__ISOTHERM_REPORT__";

// In JSON a `<` can only stand inside a string, where this is the same character.
void append_escaped(std::string& page, std::string_view text) {
  std::size_t start = 0;
  while (true) {
    const std::size_t found = text.find('<', start);
    page.append(text.substr(start, found - start));
    if (found == std::string_view::npos) return;
    page += "\\u003c";
    start = found + 1;
  }
}

}  // namespace

std::string report_text(const Json& document) {
  return document.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string report_page(const Json& document) {
  const std::string_view page_template = report_template();
  const std::size_t place = page_template.find(kPlaceholder);
  if (place == std::string_view::npos) throw std::logic_error("the report template has no place");
  const std::string text = report_text(document);
  std::string page;
  page.reserve(page_template.size() + text.size());
  page.append(page_template.substr(0, place));
  append_escaped(page, text);
  page.append(page_template.substr(place + kPlaceholder.size()));
  return page;
}

}  // namespace isotherm::apps
