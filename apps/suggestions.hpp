#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace isotherm::apps {

/// The words of the command line after the program's name; `help prune` is `prune --help`.
std::vector<std::string> command_words(int argc, char** argv);

/// After `root` refused `words`: which verb or flag is not known, and which one was probably
/// meant. Empty if it is something else that is wrong.
std::string what_was_meant(const CLI::App& root, const std::vector<std::string>& words);

}  // namespace isotherm::apps
