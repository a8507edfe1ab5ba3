#include "manual/man_page.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "isotherm/base/error.hpp"

namespace isotherm::apps {
namespace {

// As man(7) takes it: hyphens that are hyphens, and no line that begins like a request.
std::string plain(const std::string& text) {
  std::string safe;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) safe += "\\&";
    if (c == '-') {
      safe += "\\-";
    } else if (c == '\\') {
      safe += "\\e";
    } else {
      safe += c;
    }
    line_begins = c == '\n';
  }
  return safe;
}

std::string option_text(const OptionWords& option) {
  std::vector<std::string> names;
  for (const auto& name : option.names) names.push_back("\\fB" + plain(name) + "\\fR");
  std::string text = fmt::format(".TP\n{}", fmt::join(names, ", "));
  if (!option.value.empty() && !option.positional) {
    text += " \\fI" + plain(option.value) + "\\fR";
  }
  text += "\n" + plain(option.help);
  if (!option.fallback.empty()) text += plain(fmt::format(" [{}]", option.fallback));
  return text + "\n";
}

std::string synopsis(const VerbWords& verb) {
  std::string text = "\\fBisotherm " + plain(full_name(verb)) + "\\fR";
  for (const auto& option : verb.options) {
    if (option.positional) text += " \\fI" + plain(option.names.front()) + "\\fR";
  }
  return text + (verb.below.empty() ? " [\\fIoptions\\fR]" : " \\fIverb\\fR [\\fIoptions\\fR]") +
         "\n";
}

std::string options_text(const VerbWords& verb) {
  std::string text;
  for (const auto& option : verb.options) text += option_text(option);
  if (!verb.footer.empty()) text += ".PP\n.nf\n" + plain(verb.footer) + "\n.fi\n";
  return text;
}

std::string head(const std::string& page, const std::string& summary) {
  return fmt::format(
      ".TH \"{}\" \"1\" \"\" \"Isotherm {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n", plain(page),
      ISOTHERM_VERSION, plain(page), plain(summary));
}

bool is_below(const VerbWords& verb, const VerbWords& other) {
  return verb.name.size() > other.name.size() &&
         std::equal(other.name.begin(), other.name.end(), verb.name.begin());
}

std::string root_page(const std::vector<VerbWords>& verbs) {
  std::string text = head("isotherm", "find the edges that do not belong in a geometric graph");
  text += ".SH SYNOPSIS\n\\fBisotherm\\fR \\fIverb\\fR [\\fIoptions\\fR]\n.SH VERBS\n";
  for (const auto& verb : verbs) {
    if (verb.name.size() != 1) continue;
    text += ".TP\n\\fBisotherm\\-" + plain(verb.name[0]) + "\\fR(1)\n" + plain(verb.summary) + "\n";
  }
  return text + ".SH OPTIONS\n" + options_text(verbs.front()) +
         ".SH EXIT STATUS\n0 done, 1 failure, 2 usage, 3 a file that cannot be used, 4 not "
         "converged, 130 interrupted.\n";
}

}  // namespace

std::string man_page(const std::vector<VerbWords>& verbs, const std::string& name) {
  if (name.empty()) return root_page(verbs);
  const auto& verb = find_verb(verbs, name);
  if (verb.name.size() != 1) throw InvalidArgument("verb", "'" + name + "' is below another one");
  std::string text = head("isotherm-" + name, verb.summary) + ".SH SYNOPSIS\n" + synopsis(verb);
  text += ".SH OPTIONS\n" + options_text(verb);
  for (const auto& other : verbs) {
    if (!is_below(other, verb)) continue;
    text += ".SH \"" + plain(full_name(other)) + "\"\n" + plain(other.summary) + "\n.PP\n";
    text += synopsis(other) + options_text(other);
  }
  return text + ".SH SEE ALSO\n\\fBisotherm\\fR(1)\n";
}

}  // namespace isotherm::apps
