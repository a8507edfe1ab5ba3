#pragma once

#include <vector>

#include "prune/consensus/estimate/belief.hpp"
#include "prune/consensus/estimate/estimate.hpp"
#include "prune/consensus/estimate/reduced_graph.hpp"

namespace isotherm::slam::detail {

/// A loop stated from the earlier vertex to the later one.
template <class Pose>
struct ForwardLoop {
  Index from = 0;  ///< vertices of the full graph, from <= to
  Index to = 0;
  UncertainPose<Pose> measured;  ///< T_from_to
};

/// A loop of `graph`, with its covariance calibrated.
template <class Pose>
ForwardLoop<Pose> forward_loop(const ReducedGraph<Pose>& graph, const Link<Pose>& loop,
                               const CovarianceScale& scale);

/// Every loop of `graph`, in order.
template <class Pose>
std::vector<ForwardLoop<Pose>> forward_loops(const ReducedGraph<Pose>& graph,
                                             const CovarianceScale& scale);

/// Whether one measurement of a relative pose repeats the other. No two measurements are the same
/// to the last digit: a copy vouches for nothing, and says nothing of how accurate either
/// is. Only that the robot is back where it was is said the same way by each.
template <class Pose>
bool measure_the_same(const Pose& a, const Pose& b);

/// Whether one loop is a copy of the other.
template <class Pose>
bool is_copy(const Link<Pose>& a, const Link<Pose>& b) {
  return measure_the_same(a.T_a_b, b.T_a_b);
}

/// What `known` and the two pieces of odometry between their ends say of the residual of
/// `measured`. That does not depend on the estimate, nor on how far odometry has drifted between
/// the two ends of the loops. Both must run between the same chains.
template <class Pose>
Belief<Pose> pair_belief(const ReducedGraph<Pose>& graph, const CovarianceScale& scale,
                         const ForwardLoop<Pose>& known, const ForwardLoop<Pose>& measured);

/// The same with the error of `measured`, too.
template <class Pose>
Belief<Pose> pair_residual(const ReducedGraph<Pose>& graph, const CovarianceScale& scale,
                           const ForwardLoop<Pose>& known, const ForwardLoop<Pose>& measured);

}  // namespace isotherm::slam::detail
