#pragma once

#include <string>

#include "isotherm/slam/prune/consensus.hpp"

namespace isotherm::slam::detail {

/// One sentence on why a loop has its verdict.
std::string reason_of(const spectral::EdgeVerdict& verdict, double chi2);

/// The same of one that is kept for the sake of the loops next to it.
std::string reason_together(double chi2);

}  // namespace isotherm::slam::detail
