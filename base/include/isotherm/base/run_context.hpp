#pragma once

#include <cstdint>

#include "isotherm/base/progress.hpp"

namespace isotherm {

/// How a computation runs, apart from what it computes.
struct RunContext {
  int threads = 0;  ///< >= 0, at most one a core works; 0: all cores; results do not depend on it
  ProgressCallback progress = {};
  std::uint64_t seed = 0;  ///< of the random choices, where some are made
};

}  // namespace isotherm
