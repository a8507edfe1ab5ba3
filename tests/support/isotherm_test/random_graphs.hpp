#pragma once

#include <Eigen/Cholesky>

#include "isotherm/base/random.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm_test {

/// A tangent with normal entries of the given standard deviation.
template <class Pose>
typename Pose::Tangent random_tangent(isotherm::Random& random, double sigma) {
  typename Pose::Tangent xi;
  for (int k = 0; k < Pose::kDof; ++k) xi[k] = random.normal(0.0, sigma);
  return xi;
}

/// A symmetric positive definite matrix that is far from diagonal.
template <class Pose>
typename Pose::Matrix random_information(isotherm::Random& random, double scale) {
  typename Pose::Matrix a;
  for (int r = 0; r < Pose::kDof; ++r) {
    for (int c = 0; c < Pose::kDof; ++c) a(r, c) = random.normal();
  }
  return scale * (a * a.transpose() + 0.1 * Pose::Matrix::Identity());
}

/// Normal, of this information, `noise` times as large.
template <class Pose>
typename Pose::Tangent random_error(isotherm::Random& random,
                                    const typename Pose::Matrix& information, double noise = 1.0) {
  const Eigen::LLT<typename Pose::Matrix> factor(information);
  return factor.matrixU().solve(random_tangent<Pose>(random, noise));
}

/// `n` poses in a chain with random steps and full information matrices, every
/// third odometry edge stored backwards; no loops, no initial poses.
template <class Pose>
isotherm::slam::PoseGraph<Pose> random_chain(isotherm::Random& random, int n,
                                             double information = 1e4) {
  isotherm::slam::PoseGraph<Pose> graph;
  for (int v = 0; v < n; ++v) graph.ids.push_back(static_cast<isotherm::slam::VertexId>(v));
  for (int v = 0; v + 1 < n; ++v) {
    isotherm::slam::Constraint<Pose> step;
    step.from = v;
    step.to = v + 1;
    step.T_from_to = Pose::exp(random_tangent<Pose>(random, 0.5));
    step.information = random_information<Pose>(random, information);
    if (v % 3 == 2) {
      std::swap(step.from, step.to);
      step.T_from_to = step.T_from_to.inverse();
    }
    graph.constraints.push_back(step);
  }
  return graph;
}

}  // namespace isotherm_test
