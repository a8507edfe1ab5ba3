#pragma once

#include <vector>

#include <Eigen/Core>

#include "isotherm/spectral/edges/edge_verdicts.hpp"
#include "ranges/fit.hpp"
#include "ranges/known_world.hpp"

namespace isotherm::slam::detail {

/// One a range, in order, by the probability that it is correct given all others: its error and
/// the spread of its prediction are those without it. A range that nothing else checks, or of a
/// node without a place, is ambiguous.
template <class Pose>
spectral::EdgeVerdicts range_verdicts(const KnownWorld<Pose>& world,
                                      const RangeProblem<Pose>& problem,
                                      const RangeEstimate<Pose>& at, const FitSummary& summary,
                                      double doubt);

/// Of the positions of the first `nodes` nodes, in the frame of the map; zero for those held,
/// empty where there is none or where the system is singular.
template <class Pose>
std::vector<Eigen::MatrixXd> position_covariances(const RangeProblem<Pose>& problem,
                                                  const RangeEstimate<Pose>& at, Index nodes);

}  // namespace isotherm::slam::detail
