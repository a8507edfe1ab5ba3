#include "prune/consensus/odometry/odometry_component.hpp"

#include <vector>

#include "isotherm/base/parallel.hpp"

namespace isotherm::slam::detail {
namespace {

// Of an edge with covariance Sigma (of one that slips, what of that is odometry's: C Sigma_slip^-1
// C, the derivative of C by the log of a factor on it) whose error `carry` leads to the end of its
// step: a factor on coordinate d adds (e_d e_d' Sigma + Sigma e_d e_d') / 2 to Sigma.
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
            visit_edges(odometry, k, [&](Index v, const Matrix& carry, const Matrix& Sigma) {
              const std::uint8_t slip = slip_of(odometry.slips, v);
              if (slip == 0) return add(carry, Sigma);
              const Matrix C = slipped<Pose>(*odometry.chain[v], Sigma, slip, scale).covariance;
              add(carry, C * Sigma.inverse() * C / slip_factor(slip));
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
