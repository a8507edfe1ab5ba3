#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "prune/consensus/estimate/belief.hpp"
#include "prune/consensus/estimate/reduced_graph.hpp"
#include "prune/consensus/odometry/slips.hpp"
#include "prune/consensus/odometry/turn_bias.hpp"

namespace isotherm::slam::detail {

/// One edge of an odometry chain, between a vertex and the next.
template <class Pose>
struct ChainEdge {
  Pose T;                            ///< from the vertex to the next
  bool forward;                      ///< told from the vertex
  typename Pose::Matrix covariance;  ///< where it is told from, as stated
};

/// That of each vertex to the next; empty where there is none.
template <class Pose>
using Chain = std::vector<std::optional<ChainEdge<Pose>>>;

/// Of a graph's odometry.
template <class Pose>
Chain<Pose> chain_of(const PoseGraph<Pose>& graph, const EdgeRoles& roles);

/// A chain with factors on the variances of its coordinates and a bias, and what was contracted of
/// it.
template <class Pose>
struct ContractedChain {
  const Chain<Pose>& chain;
  const typename Pose::Tangent& shape;
  const Slips& slips;
  const TurnBias<Pose>& bias;
  const ReducedGraph<Pose>& reduced;
};

/// Calls `visit` with the first vertex of each edge that step `k` consists of, the matrix that
/// carries an error of the edge to the step's end, and the edge's covariance: from the last edge to
/// the first.
template <class Pose, class Visit>
void visit_edges(const ContractedChain<Pose>& odometry, std::size_t k, Visit&& visit) {
  using Matrix = typename Pose::Matrix;
  const auto& [chain, shape, slips, bias, reduced] = odometry;
  const Link<Pose>& step = reduced.steps[k];
  const typename Pose::Tangent root = shape.cwiseSqrt();
  Pose onward;  // from the edge's end to the step's
  for (Index v = reduced.vertex[step.b] - 1; v >= reduced.vertex[step.a]; --v) {
    const ChainEdge<Pose>& edge = *chain[v];
    const double factor = slip_factor(slip_of(slips, v));
    const Matrix Sigma = factor * (root.asDiagonal() * edge.covariance * root.asDiagonal());
    const Pose from_start = turned(edge.T, bias) * onward;
    visit(v, Matrix((edge.forward ? onward : from_start).inverse().adjoint()), Sigma);
    onward = from_start;
  }
}

/// The error of a step where odometry and loops agree best.
template <class Pose>
struct StepError {
  typename Pose::Tangent pull;  ///< Omega r
  typename Pose::Matrix spare;  ///< Omega - Omega P Omega / scale: what of it is left over
};

/// Where the factor on its covariance is `scale`.
template <class Pose>
StepError<Pose> step_error(const Link<Pose>& step, const Belief<Pose>& residual, double scale) {
  const typename Pose::Matrix fitted = step.information * residual.P;
  return {step.information * residual.r, step.information - fitted * step.information / scale};
}

}  // namespace isotherm::slam::detail
