#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace isotherm {

/// `1 loop`, `3 loops`: a number and what it counts. `many` is for nouns that take no s.
std::string counted(std::uint64_t count, std::string_view one, std::string_view many = {});

/// The one of `known` that a person most likely meant by `typed`: at most a third of its
/// letters have to be changed, added, left out or exchanged with their neighbour. Empty if
/// there is none.
std::string nearest_word(std::string_view typed, const std::vector<std::string>& known);

}  // namespace isotherm
