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
void add_step(const std::vector<std::optional<ChainEdge<Pose>>>& chain,
              const typename Pose::Tangent& shape, const ReducedGraph<Pose>& reduced,
              const Link<Pose>& step, const StepError<Pose>& error, OdometryComponent<Pose>& sum) {
  using Matrix = typename Pose::Matrix;
  const typename Pose::Tangent root = shape.cwiseSqrt();
  Pose onward;  // from the edge's end to the step's
  for (Index v = reduced.vertex[step.b]; v > reduced.vertex[step.a]; --v) {
    const ChainEdge<Pose>& edge = *chain[v - 1];
    const Matrix Sigma = root.asDiagonal() * edge.covariance * root.asDiagonal();
    const Matrix carry = (edge.forward ? onward : edge.T * onward).inverse().adjoint();
    add_edge<Pose>(error, carry, Sigma, sum);
    onward = edge.T * onward;
  }
}

}  // namespace

template <class Pose>
std::vector<std::optional<ChainEdge<Pose>>> chain_of(const PoseGraph<Pose>& graph,
                                                     const EdgeRoles& roles) {
  std::vector<std::optional<ChainEdge<Pose>>> chain;
  for (const auto& edge : chain_edges(graph, roles)) {
    auto& next = chain.emplace_back();
    if (!edge) continue;
    const auto& told = graph.constraints[*edge];
    const bool forward = told.from < told.to;
    next = {forward ? told.T_from_to : told.T_from_to.inverse(), forward,
            covariance_from_information<Pose::kDof>(told.information)};
  }
  return chain;
}

template <class Pose>
OdometryComponent<Pose> odometry_component(const std::vector<std::optional<ChainEdge<Pose>>>& chain,
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
            add_step(chain, shape, reduced, step, error, parts[block]);
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

template std::vector<std::optional<ChainEdge<Pose2>>> chain_of(const PoseGraph<Pose2>&,
                                                               const EdgeRoles&);
template std::vector<std::optional<ChainEdge<Pose3>>> chain_of(const PoseGraph<Pose3>&,
                                                               const EdgeRoles&);
template OdometryComponent<Pose2> odometry_component(
    const std::vector<std::optional<ChainEdge<Pose2>>>&, const Pose2::Tangent&, double,
    const ReducedGraph<Pose2>&, const Estimate<Pose2>&, std::span<const Pose2::Matrix>, int);
template OdometryComponent<Pose3> odometry_component(
    const std::vector<std::optional<ChainEdge<Pose3>>>&, const Pose3::Tangent&, double,
    const ReducedGraph<Pose3>&, const Estimate<Pose3>&, std::span<const Pose3::Matrix>, int);

}  // namespace isotherm::slam::detail
