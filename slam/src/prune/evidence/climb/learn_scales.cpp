#include "prune/evidence/climb/learn_scales.hpp"

#include <algorithm>
#include <cmath>

#include "prune/evidence/objective/scale_prior.hpp"

namespace isotherm::slam::detail {
namespace {

const double kMostChange = std::log(100.0);
// Beyond, double precision has no digits left for the rest of the graph.
const double kMostScale = std::log(1e8);

// The log of a factor whose evidence peaks at log(cost / redundancy) with curvature
// redundancy / 2, drawn towards 0 by its prior.
double learnt(double cost, double redundancy, double before) {
  if (redundancy < 1.0 || !(cost > 0.0)) return before;
  const double precision = 0.5 * redundancy;
  const double peak = std::log(cost / redundancy) * precision /
                      (precision + 1.0 / (kScaleDeviation * kScaleDeviation));
  const double from = std::log(before);
  return std::exp(std::clamp(std::clamp(peak, from - kMostChange, from + kMostChange), -kMostScale,
                             kMostScale));
}

}  // namespace

template <class Pose>
CovarianceScale learn_scales(const ReducedGraph<Pose>& graph, const Estimate<Pose>& estimate,
                             const std::vector<bool>& accepted, const std::vector<double>& weights,
                             const CovarianceScale& scale) {
  std::vector<Index> loops;
  for (std::size_t k = 0; k < accepted.size(); ++k) {
    if (accepted[k] && graph.loops[k].a != graph.loops[k].b) loops.push_back(static_cast<Index>(k));
  }
  const auto covariances = estimate.relative_covariances(loops);
  double cost = 0.0;
  double redundancy = 0.0;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const auto& loop = graph.loops[loops[k]];
    const typename Pose::Tangent r = estimate.residual(loop);
    const typename Pose::Matrix J = residual_jacobian<Pose>(r);
    const double known = (loop.information * J * covariances[k] * J.transpose()).trace();
    const double unit = weights[loops[k]];
    redundancy += Pose::kDof - known * unit / scale.loops;
    cost += unit * r.dot(loop.information * r);
  }
  const auto constraints = static_cast<double>(graph.steps.size() + loops.size());
  const auto unknowns = static_cast<double>(estimate.variable_count());
  CovarianceScale next = scale;
  next.loops = learnt(cost, redundancy, scale.loops);
  next.odometry = learnt(estimate.odometry_cost(),
                         Pose::kDof * (constraints - unknowns) - redundancy, scale.odometry);
  return next;
}

template CovarianceScale learn_scales(const ReducedGraph<Pose2>&, const Estimate<Pose2>&,
                                      const std::vector<bool>&, const std::vector<double>&,
                                      const CovarianceScale&);
template CovarianceScale learn_scales(const ReducedGraph<Pose3>&, const Estimate<Pose3>&,
                                      const std::vector<bool>&, const std::vector<double>&,
                                      const CovarianceScale&);

}  // namespace isotherm::slam::detail
