#pragma once

#include <span>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

namespace isotherm::apps {

/// `name` on the left, `text` wrapped on the right, below each other where the name is too
/// long.
std::string help_row(const std::string& name, const std::string& text);

/// What a choice of an option is called, and what it needs, when to take it and what it costs.
struct HelpChoice {
  std::string_view name;
  std::string_view use;
};

/// The choices below a heading such as "Methods:", a row each, with an empty line after them.
std::string help_table(std::string_view heading, std::span<const HelpChoice> choices);

/// Help pages that fit a terminal of 80 columns: descriptions are wrapped beside
/// their option instead of running on.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter();

  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_subcommand(const CLI::App* verb) const override;
};

}  // namespace isotherm::apps
