#include "help_formatter.hpp"

#include <sstream>
#include <string>

namespace isotherm::apps {
namespace {

constexpr std::size_t kLineWidth = 80;
constexpr std::size_t kNameWidth = 30;

}  // namespace

std::string help_row(const std::string& name, const std::string& text) {
  std::string page = "  " + name;
  std::size_t column = page.size();
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
