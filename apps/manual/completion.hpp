#pragma once

#include <array>
#include <string>
#include <vector>

#include "isotherm/base/options.hpp"
#include "manual/command_words.hpp"

namespace isotherm::apps {

enum class Shell { bash, zsh, fish };

constexpr std::array<EnumName<Shell>, 3> enum_names(Shell) {
  return {{{Shell::bash, "bash"}, {Shell::zsh, "zsh"}, {Shell::fish, "fish"}}};
}

/// A script by which the shell completes verbs, options, their choices, and files.
std::string completion_script(Shell shell, const std::vector<VerbWords>& verbs);

}  // namespace isotherm::apps
