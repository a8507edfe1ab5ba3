#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace isotherm::apps {

/// `name` on the left, `text` wrapped on the right, below each other where the name is too
/// long.
std::string help_row(const std::string& name, const std::string& text);

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
