#pragma once

#include <string>
#include <vector>

#include "manual/command_words.hpp"

namespace isotherm::apps {

/// The manual page isotherm(1), or isotherm-<verb>(1) with all verbs below it, for `man`.
/// @throws InvalidArgument unless `name` is empty or that of a verb of the root
std::string man_page(const std::vector<VerbWords>& verbs, const std::string& name);

}  // namespace isotherm::apps
