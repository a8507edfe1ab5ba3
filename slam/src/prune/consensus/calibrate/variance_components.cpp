#include "prune/consensus/calibrate/variance_components.hpp"

namespace isotherm::slam::detail {
namespace {

double over_redundancy(double cost, double redundancy, double otherwise) {
  return redundancy < 1.0 ? otherwise : cost / redundancy;
}

}  // namespace

template <class Pose>
CovarianceScale variance_components(const ReducedGraph<Pose>& graph, const Estimate<Pose>& estimate,
                                    const std::vector<bool>& accepted,
                                    const std::vector<double>& probability,
                                    const CovarianceScale& scale) {
  std::vector<Index> loops;
  for (std::size_t k = 0; k < accepted.size(); ++k) {
    if (accepted[k] && graph.loops[k].a != graph.loops[k].b) loops.push_back(static_cast<Index>(k));
  }
  const auto covariances = estimate.relative_covariances(loops);
  double loop_cost = 0.0;
  double loop_redundancy = 0.0;
  double weighted_redundancy = 0.0;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const auto& loop = graph.loops[loops[k]];
    const typename Pose::Tangent r = estimate.residual(loop);
    const typename Pose::Matrix J = residual_jacobian<Pose>(r);
    const double known = (loop.information * J * covariances[k] * J.transpose()).trace();
    const double redundancy = Pose::kDof - known / scale.loops;
    const double weight = probability[loops[k]];
    loop_cost += weight * r.dot(loop.information * r);
    weighted_redundancy += weight * redundancy;
    loop_redundancy += redundancy;
  }
  const auto constraints = static_cast<double>(graph.steps.size() + loops.size());
  const auto unknowns = static_cast<double>(graph.node_count() - estimate.component_count());
  const double redundancy = Pose::kDof * (constraints - unknowns);
  return {over_redundancy(estimate.odometry_cost().sum(), redundancy - loop_redundancy, scale.odometry),
          over_redundancy(loop_cost, weighted_redundancy, scale.loops)};
}

template CovarianceScale variance_components(const ReducedGraph<Pose2>&, const Estimate<Pose2>&,
                                             const std::vector<bool>&, const std::vector<double>&,
                                             const CovarianceScale&);
template CovarianceScale variance_components(const ReducedGraph<Pose3>&, const Estimate<Pose3>&,
                                             const std::vector<bool>&, const std::vector<double>&,
                                             const CovarianceScale&);

}  // namespace isotherm::slam::detail
