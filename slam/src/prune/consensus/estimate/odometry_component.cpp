#include "prune/consensus/estimate/odometry_component.hpp"

#include "isotherm/base/parallel.hpp"
#include "isotherm/slam/graph/information.hpp"

namespace isotherm::slam::detail {
namespace {

/// The error of a step at the peak, and what of it is left over.
template <class Pose>
struct StepError {
  typename Pose::Tangent pull;  // Omega r
  typename Pose::Matrix spare;  // Omega - Omega P Omega / scale, P the residual's covariance
};

template <class Pose>
StepError<Pose> step_error(const Link<Pose>& step, const typename Pose::Tangent& r,
                           const typename Pose::Matrix& P, double scale) {
  const typename Pose::Matrix fitted = step.information * P;
  return {step.information * r, step.information - fitted * step.information / scale};
}

// Of an edge with covariance Sigma whose error `carry` leads to the end of its step: a factor on
// coordinate d adds (e_d e_d' Sigma + Sigma e_d e_d') / 2 to Sigma.
template <class Pose>
void add_edge(const StepError<Pose>& step, const typename Pose::Matrix& carry,
              const typename Pose::Matrix& Sigma, OdometryComponent<Pose>& sum) {
  const typename Pose::Matrix reach = carry * Sigma;
  sum.cost += (carry.transpose() * step.pull).cwiseProduct(reach.transpose() * step.pull);
  sum.redundancy += carry.cwiseProduct(step.spare * reach).colwise().sum().transpose();
}

// Of a step's edges.
template <class Pose>
void add_step(const PoseGraph<Pose>& graph, const std::vector<std::optional<Index>>& edges,
              const typename Pose::Tangent& shape, const ReducedGraph<Pose>& reduced,
              const Link<Pose>& step, const StepError<Pose>& error, OdometryComponent<Pose>& sum) {
  using Matrix = typename Pose::Matrix;
  const typename Pose::Tangent root = shape.cwiseSqrt();
  Pose onward;  // from the edge's end to the step's
  for (Index v = reduced.vertex[step.b]; v > reduced.vertex[step.a]; --v) {
    const auto& edge = graph.constraints[*edges[v - 1]];
    const bool forward = edge.from < edge.to;
    const Matrix Sigma = root.asDiagonal() *
                         covariance_from_information<Pose::kDof>(edge.information) *
                         root.asDiagonal();
    const Matrix carry = onward.inverse().adjoint();
    add_edge<Pose>(error, forward ? carry : Matrix(carry * edge.T_from_to.adjoint()), Sigma, sum);
    onward = (forward ? edge.T_from_to : edge.T_from_to.inverse()) * onward;
  }
}

}  // namespace

template <class Pose>
OdometryComponent<Pose> odometry_component(const PoseGraph<Pose>& graph,
                                           const std::vector<std::optional<Index>>& edges,
                                           const typename Pose::Tangent& shape, double scale,
                                           const ReducedGraph<Pose>& reduced,
                                           const Estimate<Pose>& estimate,
                                           std::span<const typename Pose::Matrix> covariances,
                                           int threads) {
  std::vector<OdometryComponent<Pose>> parts(parallel_block_count(reduced.steps.size()));
  parallel_in_blocks(
      reduced.steps.size(), threads, [&](std::size_t block, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
          const auto& step = reduced.steps[k];
          const auto error = step_error<Pose>(step, estimate.residual(step), covariances[k], scale);
          if (k >= reduced.contracted) {  // an edge by itself
            add_edge<Pose>(error, Pose::Matrix::Identity(), step.covariance, parts[block]);
          } else {
            add_step(graph, edges, shape, reduced, step, error, parts[block]);
          }
        }
      });
  OdometryComponent<Pose> sum;
  for (const auto& part : parts) {
    sum.cost += part.cost;
    sum.redundancy += part.redundancy;
  }
  sum.redundancy = sum.redundancy.cwiseMax(0.0);
  return sum;
}

template OdometryComponent<Pose2> odometry_component(const PoseGraph<Pose2>&,
                                                     const std::vector<std::optional<Index>>&,
                                                     const Pose2::Tangent&, double,
                                                     const ReducedGraph<Pose2>&,
                                                     const Estimate<Pose2>&,
                                                     std::span<const Pose2::Matrix>, int);
template OdometryComponent<Pose3> odometry_component(const PoseGraph<Pose3>&,
                                                     const std::vector<std::optional<Index>>&,
                                                     const Pose3::Tangent&, double,
                                                     const ReducedGraph<Pose3>&,
                                                     const Estimate<Pose3>&,
                                                     std::span<const Pose3::Matrix>, int);

}  // namespace isotherm::slam::detail
