#include "prune/consensus/odometry/odometry_component.hpp"

#include <vector>

#include "isotherm/base/parallel.hpp"

namespace isotherm::slam::detail {
namespace {

// Of an edge with covariance Sigma whose error `carry` leads to the end of its step: a factor on
// coordinate d adds (e_d e_d' Sigma + Sigma e_d e_d') / 2 to Sigma.
template <class Pose>
void add_edge(const StepError<Pose>& step, const typename Pose::Matrix& carry,
              const typename Pose::Matrix& Sigma, OdometryComponent<Pose>& sum) {
  const typename Pose::Matrix reach = carry * Sigma;
  sum.cost += (carry.transpose() * step.pull).cwiseProduct(reach.transpose() * step.pull);
  sum.redundancy += carry.cwiseProduct(step.spare * reach).colwise().sum().transpose();
}

}  // namespace

template <class Pose>
OdometryComponent<Pose> odometry_component(const ContractedChain<Pose>& odometry, double scale,
                                           std::span<const Belief<Pose>> residuals, int threads) {
  using Matrix = typename Pose::Matrix;
  const auto& reduced = odometry.reduced;
  std::vector<OdometryComponent<Pose>> parts(parallel_block_count(reduced.steps.size()));
  parallel_in_blocks(
      reduced.steps.size(), threads, [&](std::size_t block, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
          const auto& step = reduced.steps[k];
          const auto error = step_error<Pose>(step, residuals[k], scale);
          const auto add = [&](const Matrix& carry, const Matrix& Sigma) {
            add_edge<Pose>(error, carry, Sigma, parts[block]);
          };
          if (k >= reduced.contracted) {  // an edge by itself
            add(Matrix::Identity(), step.covariance);
          } else {
            visit_edges(odometry, k, [&](Index, const Matrix& carry, const Matrix& Sigma) {
              add(carry, Sigma);
            });
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

template OdometryComponent<Pose2> odometry_component(const ContractedChain<Pose2>&, double,
                                                     std::span<const Belief<Pose2>>, int);
template OdometryComponent<Pose3> odometry_component(const ContractedChain<Pose3>&, double,
                                                     std::span<const Belief<Pose3>>, int);

}  // namespace isotherm::slam::detail
