#include "prune/evidence/objective/objective.hpp"

#include <cmath>

#include <Eigen/Cholesky>

#include "prune/consensus/estimate/log_normal.hpp"
#include "prune/consensus/estimate/map_volume.hpp"
#include "prune/evidence/objective/scale_prior.hpp"

namespace isotherm::slam::detail {
namespace {

// log of the probability that exactly `kept` given ones of `all` loops are true.
double log_beta_binomial(double kept, double all) {
  return std::lgamma(kept + 1.0) + std::lgamma(all - kept + 1.0) - std::lgamma(all + 2.0);
}

}  // namespace

template <class Pose>
Objective<Pose>::Objective(const ReducedGraph<Pose>& graph, Index window)
    : graph_(graph), near_(graph), runs_(graph, window) {
  const MapVolume<Pose> map(graph.poses);
  log_volume_ = 0.5 * (map.variance().array().log().sum() + Pose::kDof * kLog2Pi);
  Estimate<Pose> odometry(graph);
  odometry.update(std::vector<bool>(graph.loops.size(), false), {}, 0);
  odometry_log_determinant_ = odometry.log_determinant();
  odometry_variables_ = odometry.variable_count();
  for (const auto& loop : graph.loops) {
    log_sigma_.push_back(log_determinant(Eigen::LLT<typename Pose::Matrix>(loop.covariance)));
  }
}

template <class Pose>
double Objective<Pose>::log_alternative(Index loop, const NearByClass& near,
                                        double loop_scale) const {
  if (!runs_.copied(loop)) {
    return near[proposal_class(graph_, loop)] + near_.log_false_density(loop, loop_scale);
  }
  const double log_sigma = log_sigma_[loop] + Pose::kDof * std::log(loop_scale);
  return -0.5 * (log_sigma + Pose::kDof * kLog2Pi) - Pose::kDof;
}

// Log densities of the accepted loops at the peak, and of their scales.
template <class Pose>
double Objective<Pose>::loops_fit(const Explanation<Pose>& explanation,
                                  const Estimate<Pose>& estimate) const {
  const double scale = explanation.scale.loops;
  double fit = explanation.scale_evidence + explanation.found.log_evidence();
  for (std::size_t k = 0; k < explanation.accepted.size(); ++k) {
    if (!explanation.accepted[k]) continue;
    const auto& link = graph_.loops[k];
    const typename Pose::Tangent r = estimate.residual(link);
    const double chi2 = explanation.weights[k] * r.dot(link.information * r) / scale;
    fit -= 0.5 * (chi2 + log_sigma_[k] + Pose::kDof * (kLog2Pi + std::log(scale)));
  }
  return fit;
}

template <class Pose>
double Objective<Pose>::evidence(const Explanation<Pose>& explanation,
                                 const Estimate<Pose>& estimate, const NearByClass& near) const {
  const CovarianceScale& scale = explanation.scale;
  double alternatives = 0.0;
  double kept = 0.0;
  for (std::size_t k = 0; k < explanation.accepted.size(); ++k) {
    if (!explanation.accepted[k]) continue;
    alternatives += log_alternative(static_cast<Index>(k), near, scale.loops);
    kept += 1.0;
  }
  const double odometry_determinant =
      odometry_log_determinant_ - Pose::kDof * odometry_variables_ * std::log(scale.odometry);
  const auto joined = static_cast<double>(estimate.variable_count() - odometry_variables_);
  return loops_fit(explanation, estimate) - 0.5 * estimate.odometry_cost() / scale.odometry -
         0.5 * (estimate.log_determinant() - odometry_determinant) +
         joined * (0.5 * Pose::kDof * kLog2Pi - log_volume_) - alternatives +
         log_beta_binomial(kept, static_cast<double>(explanation.accepted.size())) +
         log_scale_prior(scale.odometry) + log_scale_prior(scale.loops);
}

template class Objective<Pose2>;
template class Objective<Pose3>;

}  // namespace isotherm::slam::detail
