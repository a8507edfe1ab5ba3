#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "matrices/decompositions.hpp"
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
  typename Pose::Tangent motion;     ///< variances of how the robot moved, by coordinate
};

/// That of each vertex to the next; empty where there is none.
template <class Pose>
using Chain = std::vector<std::optional<ChainEdge<Pose>>>;

/// Of a graph's odometry. Robots move about as far, and turn as far, as they do in a step (root
/// mean square), or as they are told to in this one.
template <class Pose>
Chain<Pose> chain_of(const PoseGraph<Pose>& graph, const EdgeRoles& roles);

/// Its covariance with factors on the variances of its coordinates.
template <class Pose>
typename Pose::Matrix shaped(const ChainEdge<Pose>& edge, const typename Pose::Tangent& shape) {
  const typename Pose::Tangent root = shape.cwiseSqrt();
  return root.asDiagonal() * edge.covariance * root.asDiagonal();
}

/// What is believed of an edge's error if it slips.
template <class Pose>
struct SlippedEdge {
  typename Pose::Matrix covariance;  ///< but for the factor on all of odometry
  double log_motion;                 ///< log of how likely the robot's motion is with such an error
};

/// Of an edge with covariance Sigma where it does not slip, Sigma_slip = slip_factor() times that
/// where it does. A robot that moved otherwise than it tells did so about as far as it moves in a
/// step, normal with the variances S of ChainEdge::motion, so that the error has the density
/// N(e; 0, Sigma_slip) exp(-e' S^-1 e / 2) = N(e; 0, C) (|C| / |Sigma_slip|)^(1/2) with
/// C^-1 = Sigma_slip^-1 + S^-1. `scale`: the factor on all of odometry, which S does not have.
template <class Pose>
SlippedEdge<Pose> slipped(const ChainEdge<Pose>& edge, const typename Pose::Matrix& Sigma,
                          std::size_t slip, double scale) {
  if (slip == 0) return {Sigma, 0.0};
  using Matrix = typename Pose::Matrix;
  const Matrix wide = slip_factor(slip) * Sigma;
  const Eigen::LLT<Matrix> told(wide);
  Matrix information = told.solve(Matrix::Identity());
  information.diagonal() += scale * edge.motion.cwiseInverse();
  const Eigen::LLT<Matrix> both(information);
  return {both.solve(Matrix::Identity()), -0.5 * (log_determinant(told) + log_determinant(both))};
}

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
/// carries an error of the edge to the step's end, and the edge's covariance where it does not
/// slip: from the last edge to the first.
template <class Pose, class Visit>
void visit_edges(const ContractedChain<Pose>& odometry, std::size_t k, Visit&& visit) {
  using Matrix = typename Pose::Matrix;
  const auto& [chain, shape, slips, bias, reduced] = odometry;
  const Link<Pose>& step = reduced.steps[k];
  Pose onward;  // from the edge's end to the step's
  for (Index v = reduced.vertex[step.b] - 1; v >= reduced.vertex[step.a]; --v) {
    const ChainEdge<Pose>& edge = *chain[v];
    const Pose from_start = turned(edge.T, bias) * onward;
    visit(v, Matrix((edge.forward ? onward : from_start).inverse().adjoint()), shaped(edge, shape));
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
