#include "prune/consensus/objective/own_frames.hpp"

#include <cmath>
#include <vector>

#include "graph/reversed.hpp"
#include "matrices/decompositions.hpp"

namespace isotherm::slam::detail {
namespace {

// What rounding can make of no dependence at either end.
constexpr double kRounding = 1e-9;

// log |Sigma_tt| + log |Sigma_rr|; |Sigma| is the same from both ends. Not a number if there is no
// covariance.
template <class Pose>
double log_volume_apart(const Constraint<Pose>& constraint) {
  using Matrix = typename Pose::Matrix;
  constexpr int kTurns = Pose::kDof - Pose::kDim;
  const Matrix covariance = Eigen::LLT<Matrix>(constraint.information).solve(Matrix::Identity());
  const auto steps = covariance.template topLeftCorner<Pose::kDim, Pose::kDim>();
  const auto turns = covariance.template bottomRightCorner<kTurns, kTurns>();
  return std::log(steps.determinant()) + std::log(turns.determinant());
}

template <class Pose>
void tell_from_own_end(const std::vector<Index>& edges, PoseGraph<Pose>& graph) {
  for (const Index k : edges) {
    graph.constraints[k] = in_own_frame(graph.constraints[k]);
  }
}

}  // namespace

template <class Pose>
PoseGraph<Pose> in_own_frames(PoseGraph<Pose> graph, const EdgeRoles& roles) {
  tell_from_own_end(roles.odometry, graph);
  tell_from_own_end(roles.candidates, graph);
  return graph;
}

template <class Pose>
Constraint<Pose> in_own_frame(const Constraint<Pose>& constraint) {
  const auto other = reversed(constraint);
  return log_volume_apart(other) < log_volume_apart(constraint) - kRounding ? other : constraint;
}

template Constraint<Pose2> in_own_frame(const Constraint<Pose2>&);
template Constraint<Pose3> in_own_frame(const Constraint<Pose3>&);
template PoseGraph<Pose2> in_own_frames(PoseGraph<Pose2>, const EdgeRoles&);
template PoseGraph<Pose3> in_own_frames(PoseGraph<Pose3>, const EdgeRoles&);

}  // namespace isotherm::slam::detail
