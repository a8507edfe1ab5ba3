#include "help_formatter.hpp"

#include <sstream>
#include <string>

namespace isotherm::apps {
namespace {

constexpr std::size_t kLineWidth = 80;
constexpr std::size_t kNameWidth = 30;

// A list of choices that is too long for a line goes on below.
std::string broken_at_choices(std::string name) {
  const std::string indent = "      ";
  for (std::size_t start = 0; name.size() - start > kLineWidth;) {
    const auto bar = name.rfind('|', start + kLineWidth - 1);
    if (bar == std::string::npos || bar <= start + indent.size()) break;
    name.insert(bar + 1, '\n' + indent);
    start = bar + 2;
  }
  return name;
}

}  // namespace

std::string help_row(const std::string& name, const std::string& text) {
  std::string page = broken_at_choices("  " + name);
  std::size_t column = page.size() - (page.rfind('\n') + 1);
  const auto to_text_column = [&] {
    if (column + 1 > kNameWidth) {
      page += '\n';
      column = 0;
    }
    page.append(kNameWidth - column, ' ');
    column = kNameWidth;
  };
  std::istringstream words(text);
  bool line_has_word = false;
  for (std::string word; words >> word;) {
    if (!line_has_word) {
      to_text_column();
    } else if (column + 1 + word.size() > kLineWidth) {
      page += '\n';
      column = 0;
      to_text_column();
    } else {
      page += ' ';
      ++column;
    }
    page += word;
    column += word.size();
    line_has_word = true;
  }
  return page + '\n';
}

std::string help_table(std::string_view heading, std::span<const HelpChoice> choices) {
  std::string table = std::string(heading) + "\n";
  for (const auto& [name, use] : choices) table += help_row(std::string(name), std::string(use));
  return table + "\n";
}

HelpFormatter::HelpFormatter() { column_width(kNameWidth); }

std::string HelpFormatter::make_option(const CLI::Option* option, bool is_positional) const {
  std::string text = make_option_desc(option);
  const std::string by_default = option->get_default_str();
  if (!by_default.empty() && by_default != "\"\"") text += " [" + by_default + "]";
  return help_row(make_option_name(option, is_positional) + make_option_opts(option), text);
}

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  std::string text;
  if (option->get_type_size() != 0 && !option->get_type_name().empty()) {
    text += ' ' + option->get_type_name();
  }
  if (option->get_expected_max() > 1) text += ",...";
  if (option->get_required()) text += " (needed)";
  return text;
}

std::string HelpFormatter::make_subcommand(const CLI::App* verb) const {
  return help_row(verb->get_name(), verb->get_description());
}

}  // namespace isotherm::apps
