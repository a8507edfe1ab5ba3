#pragma once

#include <array>
#include <span>
#include <vector>

#include "prune/consensus/odometry/step_edges.hpp"

namespace isotherm::slam::detail {

/// What it would gain that one edge errs more than others, or less than it was taken for.
struct SlipChange {
  Index vertex;  ///< the edge's first
  std::uint8_t slip;
  double gain;  ///< of log evidence
};

/// Of each row of steps for which that gains the edge for which it gains most, ascending. Exact
/// where everything is linear: the step's covariance C becomes C + D, and of its residual without
/// odometry's own word, of covariance M^-1, the log density changes. `log_odds` of an edge being of
/// a size against 0. Otherwise as odometry_component.
template <class Pose>
std::vector<SlipChange> slip_changes(const ContractedChain<Pose>& odometry, double scale,
                                     const std::array<double, kSlipSizes>& log_odds,
                                     std::span<const Belief<Pose>> residuals, int threads = 1);

}  // namespace isotherm::slam::detail
