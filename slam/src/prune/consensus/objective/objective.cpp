#include "prune/consensus/objective/objective.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "matrices/decompositions.hpp"
#include "prune/consensus/estimate/log_normal.hpp"
#include "prune/consensus/estimate/map_volume.hpp"
#include "prune/consensus/log_sum.hpp"
#include "prune/consensus/objective/own_frames.hpp"
#include "prune/consensus/objective/wrong_measurement.hpp"
#include "prune/consensus/odometry/step_spread.hpp"

namespace isotherm::slam::detail {
namespace {

// Steps that vary less, in times of what the file says that they err by, are commands or rounded.
constexpr double kLeastSpread = 1e-6;

template <class Pose>
typename Pose::Tangent most_scales(const StepSpread& spread) {
  const auto most = [](double part) {
    return part > kLeastSpread ? std::min(std::log(part), kMostScale) : kMostScale;
  };
  typename Pose::Tangent logs;
  logs.template head<Pose::kDim>().setConstant(most(spread.translation));
  logs.template tail<Pose::kDof - Pose::kDim>().setConstant(most(spread.rotation));
  return logs;
}

template <class Pose>
typename Pose::Tangent mean_variance(const Chain<Pose>& chain) {
  typename Pose::Tangent sum = Pose::Tangent::Zero();
  double edges = 0.0;
  for (const auto& edge : chain) {
    if (!edge) continue;
    sum += edge->covariance.diagonal();
    edges += 1.0;
  }
  return sum / std::max(edges, 1.0);
}

}  // namespace

template <class Pose>
Objective<Pose>::Objective(const PoseGraph<Pose>& graph, const EdgeRoles& roles, Index window,
                           bool calibrate)
    : graph_(in_own_frames(graph, roles)),
      roles_(roles),
      chain_(chain_of(graph_, roles_)),
      stated_(scaled({})),
      near_(stated_.reduced),
      runs_(stated_.reduced, window),
      log_mean_around_(near_.log_mean_around(stated_.reduced, runs_.leaders(), window)),
      window_(window),
      calibrate_(calibrate),
      most_odometry_(most_scales<Pose>(calibrate ? step_spread(graph_, roles_) : StepSpread{})),
      step_variance_(mean_variance<Pose>(chain_)) {
  const MapVolume<Pose> map(stated_.reduced.poses);
  log_volume_ = 0.5 * (map.variance().array().log().sum() + Pose::kDof * kLog2Pi);
  for (const auto& loop : stated_.reduced.loops) {
    log_sigma_.push_back(log_determinant(Eigen::LLT<typename Pose::Matrix>(loop.covariance)));
  }
}

template <class Pose>
Objective<Pose> Objective<Pose>::of(const std::vector<Index>& loops) const {
  EdgeRoles roles{.odometry = roles_.odometry, .candidates = {}};
  for (const Index k : loops) roles.candidates.push_back(roles_.candidates[k]);
  return Objective(graph_, roles, window_, calibrate_);
}

template <class Pose>
double Objective<Pose>::log_alternative(Index loop, const NearByClass& near,
                                        double loop_scale) const {
  const double by_chance = near[proposal_class(stated_.reduced, loop)];
  if (!runs_.copied(loop)) return by_chance;
  const double log_sigma = log_sigma_[loop] + Pose::kDof * std::log(loop_scale);
  return log_copy_density<Pose>(log_sigma, by_chance);
}

template <class Pose>
double Objective<Pose>::log_nearer(Index loop, const typename Pose::Tangent& r,
                                   double tail_dof) const {
  if (runs_.copied(loop)) return 0.0;
  const auto& link = stated_.reduced.loops[loop];
  return near_.log_nearer(link.T_a_b, r, stated_.reduced.is_forward(link), tail_dof);
}

template <class Pose>
double Objective<Pose>::log_place(const Explanation<Pose>& now, const ScaledGraph<Pose>& graph,
                                  Index loop, const Belief<Pose>& belief,
                                  const NearByClass& near) const {
  if (runs_.copied(loop)) return 0.0;
  const double scale = std::max(now.scale.loops, 1.0);  // what is as accurate as stated is right
  const typename Pose::Matrix covariance = scale * graph.reduced.loops[loop].covariance;
  return log_wrong<Pose>(belief.r, covariance, belief.P) + log_nearer(loop, belief.r, kWrongDof) -
         near[proposal_class(graph.reduced, loop)];
}

template <class Pose>
double Objective<Pose>::log_place(const Explanation<Pose>& now, const ScaledGraph<Pose>& graph,
                                  Index loop, const std::vector<std::vector<Pose>>& maps,
                                  const NearByClass& near) const {
  const auto& link = graph.reduced.loops[loop];
  double sum = kNever;
  for (const auto& map : maps) {
    const Belief<Pose> known{link.T_a_b.between(map[link.a].between(map[link.b])).log(),
                             Pose::Matrix::Zero()};
    sum = log_sum(sum, log_place(now, graph, loop, known, near));
  }
  return sum - std::log(static_cast<double>(maps.size()));
}

// Log densities of the accepted loops at the peak, and of their scales; how near they are.
template <class Pose>
double Objective<Pose>::loops_fit(const Explanation<Pose>& explanation,
                                  const ScaledGraph<Pose>& graph,
                                  const Estimate<Pose>& estimate) const {
  const double scale = explanation.scale.loops;
  double fit = explanation.scale_evidence + explanation.found.log_evidence();
  for (std::size_t k = 0; k < explanation.accepted.size(); ++k) {
    if (!explanation.accepted[k]) continue;
    const auto& link = graph.reduced.loops[k];
    const typename Pose::Tangent r = estimate.residual(link);
    const double chi2 = r.dot(information(explanation, graph, static_cast<Index>(k)) * r);
    fit -= 0.5 * (chi2 + log_sigma_[k] + Pose::kDof * (kLog2Pi + std::log(scale)));
    fit += log_nearer(static_cast<Index>(k), r);
  }
  return fit;
}

template <class Pose>
double Objective<Pose>::fit(const Explanation<Pose>& explanation, const ScaledGraph<Pose>& graph,
                            const Estimate<Pose>& estimate, const NearByClass& near) const {
  const CovarianceScale& scale = explanation.scale;
  double alternatives = 0.0;
  for (std::size_t k = 0; k < explanation.accepted.size(); ++k) {
    if (!explanation.accepted[k]) continue;
    alternatives += log_alternative(static_cast<Index>(k), near, scale.loops);
  }
  const auto steps = static_cast<double>(graph.reduced.steps.size());
  const double log_information =
      graph.log_information - Pose::kDof * steps * std::log(scale.odometry);
  const auto joined = static_cast<double>(estimate.variable_count() - graph.variables);
  return loops_fit(explanation, graph, estimate) - 0.5 * estimate.odometry_cost() / scale.odometry -
         0.5 * (estimate.log_determinant() - log_information) +
         joined * (0.5 * Pose::kDof * kLog2Pi - log_volume_) - alternatives +
         runs_.labels(explanation.accepted).log_evidence();
}

template <class Pose>
BiasPrior<Pose> Objective<Pose>::bias_prior(const Explanation<Pose>& explanation,
                                            const ScaledGraph<Pose>& graph) const {
  const double share = calibrate_ ? kBiasDeviation * kBiasDeviation : 0.0;
  const auto variance =
      share * explanation.scale.odometry * explanation.shapes.odometry.cwiseProduct(step_variance_);
  return {graph.by_bias, explanation.shapes.bias,
          variance.template tail<Pose::kDof - Pose::kDim>()};
}

// log of how likely it is that just these edges slip, and that the robot moved as they then tell.
template <class Pose>
double Objective<Pose>::log_slips(const Explanation<Pose>& explanation) const {
  const auto& shapes = explanation.shapes;
  double sum = log_prior_of(shapes.slips);
  for (std::size_t v = 0; v < shapes.slips.size(); ++v) {
    if (shapes.slips[v] == 0) continue;
    const auto& edge = *chain_[v];
    const auto Sigma = shaped(edge, shapes.odometry);
    sum += slipped<Pose>(edge, Sigma, shapes.slips[v], shapes.slip_scale).log_motion;
  }
  return sum;
}

template <class Pose>
double Objective<Pose>::log_scale_peak(const Explanation<Pose>& explanation) const {
  if (!calibrate_) return 0.0;
  const auto peak = [](double scale, const auto& shape, const auto& redundancy) {
    return detail::log_scale_peak(log_scales(scale, shape), redundancy);
  };
  const auto& [scale, shapes, redundancy] =
      std::tie(explanation.scale, explanation.shapes, explanation.redundancy);
  return log_slips(explanation) + peak(scale.odometry, shapes.odometry, redundancy.odometry) +
         peak(scale.loops, shapes.loops, redundancy.loops) -
         log_excess(log_scales(scale.odometry, shapes.odometry), most_odometry_, odometry_count());
}

template class Objective<Pose2>;
template class Objective<Pose3>;

}  // namespace isotherm::slam::detail
