#pragma once

#include <string>

#include "isotherm/slam/prune/consensus.hpp"

namespace isotherm::slam::detail {

/// What a loop's verdict stands on.
struct Grounds {
  double chi2 = 0.0;
  bool together = false;  ///< kept for the sake of the loops next to it
};

/// One sentence on why a loop has its verdict.
std::string reason_of(const spectral::EdgeVerdict& verdict, const Grounds& grounds);

}  // namespace isotherm::slam::detail
