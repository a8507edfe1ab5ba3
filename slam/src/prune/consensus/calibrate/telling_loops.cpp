#include "prune/consensus/calibrate/telling_loops.hpp"

#include <Eigen/Cholesky>

namespace isotherm::slam::detail {
namespace {

constexpr double kLeastShare = 0.5;

}  // namespace

template <class Pose>
std::vector<bool> telling_loops(const ReducedGraph<Pose>& graph, const Estimate<Pose>& estimate,
                                const std::vector<bool>& accepted, const CovarianceScale& scale) {
  using Matrix = typename Pose::Matrix;
  std::vector<bool> telling = accepted;
  for (std::size_t k = 0; k < accepted.size(); ++k) {
    if (!accepted[k]) continue;
    const auto& loop = graph.loops[k];
    const Matrix jacobian = residual_jacobian<Pose>(estimate.residual(loop));
    const Matrix odometry =
        jacobian * graph.odometry_covariance[k] * jacobian.transpose() * scale.odometry;
    const Matrix sum = odometry + loop.covariance * scale.loops;
    telling[k] = Eigen::LLT<Matrix>(sum).solve(odometry).trace() >= kLeastShare * Pose::kDof;
  }
  return telling;
}

template std::vector<bool> telling_loops(const ReducedGraph<Pose2>&, const Estimate<Pose2>&,
                                         const std::vector<bool>&, const CovarianceScale&);
template std::vector<bool> telling_loops(const ReducedGraph<Pose3>&, const Estimate<Pose3>&,
                                         const std::vector<bool>&, const CovarianceScale&);

}  // namespace isotherm::slam::detail
