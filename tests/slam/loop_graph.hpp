#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "isotherm/base/random.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm_test/random_graphs.hpp"

namespace isotherm_test {

/// The largest distance of two poses at the same place of both lists; 1e300 for lists of
/// different lengths.
template <class Pose>
double worst_difference(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  double worst = a.size() == b.size() ? 0.0 : 1e300;
  for (std::size_t v = 0; v < std::min(a.size(), b.size()); ++v) {
    worst = std::max(worst, (a[v].inverse() * b[v]).log().norm());
  }
  return worst;
}

/// A chain with loops, and the poses that made it.
template <class Pose>
struct LoopGraph {
  isotherm::slam::PoseGraph<Pose> graph;
  std::vector<Pose> truth;
};

/// `n` poses on a random walk with `loops` random loops; every measurement is the
/// true relative pose times exp of noise drawn from its own full information
/// matrix, whose scale is `information` (noise scaled by `noise`, 0 for none).
template <class Pose>
LoopGraph<Pose> random_loop_graph(isotherm::Random& random, int n, int loops, double noise,
                                  double information = 1e4) {
  using isotherm::slam::Index;
  LoopGraph<Pose> made;
  made.graph = random_chain<Pose>(random, n, information);
  made.truth.resize(static_cast<std::size_t>(n));
  for (int v = 0; v + 1 < n; ++v) {
    made.truth[v + 1] = made.truth[v] * Pose::exp(random_tangent<Pose>(random, 0.5));
  }
  for (int l = 0; l < loops; ++l) {
    isotherm::slam::Constraint<Pose> loop;
    loop.from = static_cast<Index>(random.index(static_cast<std::uint64_t>(n)));
    do {
      loop.to = static_cast<Index>(random.index(static_cast<std::uint64_t>(n)));
    } while (loop.to == loop.from);
    loop.information = random_information<Pose>(random, information);
    made.graph.constraints.push_back(loop);
  }
  for (auto& constraint : made.graph.constraints) {
    const auto xi = random_error<Pose>(random, constraint.information, noise);
    constraint.T_from_to =
        made.truth[constraint.from].inverse() * made.truth[constraint.to] * Pose::exp(xi);
  }
  return made;
}

/// Adds so many of an edge's own deviations to what it measures, in each coordinate.
template <class Pose>
void slip(isotherm::slam::Constraint<Pose>& step, double deviations) {
  const typename Pose::Matrix deviation =
      Eigen::LLT<typename Pose::Matrix>(step.information.inverse()).matrixL();
  step.T_from_to = step.T_from_to * Pose::exp(deviations * (deviation * Pose::Tangent::Ones()));
}

/// Has odometry tell of each turn from a vertex to the next by so much too little.
template <class Pose>
void turn_less(isotherm::slam::PoseGraph<Pose>& graph,
               const std::vector<isotherm::slam::Index>& odometry,
               const Eigen::Matrix<double, Pose::kDof - Pose::kDim, 1>& bias) {
  typename Pose::Tangent turn = Pose::Tangent::Zero();
  turn.template tail<Pose::kDof - Pose::kDim>() = -bias;
  for (const isotherm::slam::Index k : odometry) {
    auto& edge = graph.constraints[k];
    const bool forward = edge.from < edge.to;
    const Pose T = (forward ? edge.T_from_to : edge.T_from_to.inverse()) * Pose::exp(turn);
    edge.T_from_to = forward ? T : T.inverse();
  }
}

}  // namespace isotherm_test
