#include "prune/evidence/climb/learn.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "prune/evidence/objective/scale_prior.hpp"

namespace isotherm::slam::detail {
namespace {

// Beyond, double precision has no digits left for the rest of the graph.
const double kMostScale = std::log(1e8);
constexpr int kRepetitions = 10;  // of expectation maximisation, from the prior

/// Of one kind of measurement.
struct Component {
  double cost = 0.0;  // in the file's units
  double redundancy = 0.0;

  double evidence(double scale) const {
    return -0.5 * (cost / scale + redundancy * std::log(scale)) + log_scale_prior(scale);
  }

  // The log of a factor whose evidence peaks at log(cost / redundancy) with curvature
  // redundancy / 2, drawn towards 0 by its prior.
  double likeliest(double before) const {
    if (redundancy < 1.0 || !(cost > 0.0)) return before;
    const double precision = 0.5 * redundancy;
    const double peak = std::log(cost / redundancy) * precision /
                        (precision + 1.0 / (kScaleDeviation * kScaleDeviation));
    return std::exp(std::clamp(peak, -kMostScale, kMostScale));
  }
};

/// Of a loop.
struct Residual {
  double chi2 = 0.0;  // in the file's units
  double redundancy = 0.0;
  double weight = 1.0;
};

template <class Pose>
std::vector<Residual> residuals_of(const ReducedGraph<Pose>& graph,
                                   const Assessment<Pose>& assessment,
                                   const Explanation<Pose>& explanation) {
  std::vector<Residual> residuals;
  for (std::size_t k = 0; k < explanation.accepted.size(); ++k) {
    const auto& loop = graph.loops[k];
    if (!explanation.accepted[k] || loop.a == loop.b) continue;
    const double weight = explanation.weights[k];
    const typename Pose::Tangent r = assessment.estimate().residual(loop);
    const typename Pose::Matrix J = residual_jacobian<Pose>(r);
    const double known =
        (loop.information * J * assessment.covariances()[k] * J.transpose()).trace();
    residuals.push_back({r.dot(loop.information * r),
                         std::max(Pose::kDof - weight * known / explanation.scale.loops, 0.0),
                         weight});
  }
  return residuals;
}

// A residual counts as far as it is redundant: the rest of it was fitted.
ScaleShares likeliest_shares(const std::vector<Residual>& residuals, double scale, int dof) {
  ScaleShares shares;
  for (int k = 0; k < kRepetitions; ++k) {
    const ScaleMixture mixture = expected_mixture(scale, shares);
    shares = {};
    for (const auto& [chi2, redundancy, weight] : residuals) {
      const ErrorScale error = error_scale(mixture, chi2 / scale, redundancy);
      for (std::size_t j = 0; j < kScaleCount; ++j) {
        shares.loops[j] += error.probability[j] * redundancy / dof;
      }
    }
  }
  return shares;
}

double log_likelihood(const ScaleMixture& mixture, const std::vector<Residual>& residuals) {
  double sum = log_scale_prior(mixture.scale);
  for (const auto& [chi2, redundancy, weight] : residuals) {
    const ErrorScale error = error_scale(mixture, chi2 / mixture.scale, redundancy);
    sum += error.evidence -
           0.5 * (error.weight * chi2 / mixture.scale + redundancy * std::log(mixture.scale));
    for (std::size_t j = 0; j < kScaleCount; ++j) {
      sum += error.probability[j] * mixture.log_share[j];
    }
  }
  return sum;
}

}  // namespace

template <class Pose>
Lesson learn(const Objective<Pose>& objective, const Assessment<Pose>& assessment,
             const Explanation<Pose>& explanation) {
  const auto& graph = objective.graph();
  const auto& estimate = assessment.estimate();
  const auto residuals = residuals_of(graph, assessment, explanation);
  const auto constraints = static_cast<double>(graph.steps.size() + residuals.size());
  Component odometry = {
      estimate.odometry_cost(),
      Pose::kDof * (constraints - static_cast<double>(estimate.variable_count()))};
  Component loops;
  for (const auto& [chi2, redundancy, weight] : residuals) {
    loops.cost += weight * chi2;
    loops.redundancy += redundancy;
  }
  odometry.redundancy -= loops.redundancy;
  const CovarianceScale& before = explanation.scale;
  Lesson lesson;
  lesson.scale = {odometry.likeliest(before.odometry), loops.likeliest(before.loops)};
  lesson.shares = likeliest_shares(residuals, lesson.scale.loops, Pose::kDof);
  lesson.gain = odometry.evidence(lesson.scale.odometry) - odometry.evidence(before.odometry) +
                log_likelihood(expected_mixture(lesson.scale.loops, lesson.shares), residuals) -
                log_likelihood(expected_mixture(before.loops, explanation.shares), residuals);
  return lesson;
}

template Lesson learn(const Objective<Pose2>&, const Assessment<Pose2>&, const Explanation<Pose2>&);
template Lesson learn(const Objective<Pose3>&, const Assessment<Pose3>&, const Explanation<Pose3>&);

}  // namespace isotherm::slam::detail
