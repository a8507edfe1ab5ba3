#pragma once

#include <vector>

#include "isotherm/spectral/types.hpp"

namespace isotherm::slam::detail {

/// The root of a member's tree in a forest of disjoint sets, where `parent` of a root
/// is itself. Halves the path on the way, which keeps later searches short.
inline spectral::Index find_root(std::vector<spectral::Index>& parent, spectral::Index member) {
  while (parent[member] != member) {
    parent[member] = parent[parent[member]];
    member = parent[member];
  }
  return member;
}

}  // namespace isotherm::slam::detail
