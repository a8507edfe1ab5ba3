#include "prune/consensus/climb/learn.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "prune/consensus/objective/scale_prior.hpp"

namespace isotherm::slam::detail {
namespace {

// Beyond, double precision has no digits left for the rest of the graph.
const double kMostScale = std::log(1e8);
constexpr int kRepetitions = 10;  // of expectation maximisation, from the prior

// The likeliest factor where the evidence has its peak at `factor` with curvature redundancy / 2
// of the log, drawn towards 1 by the prior.
double drawn_in(double factor, double redundancy) {
  const double precision = 0.5 * redundancy;
  const double peak =
      std::log(factor) * precision / (precision + 1.0 / (kScaleDeviation * kScaleDeviation));
  return std::exp(std::clamp(peak, -kMostScale, kMostScale));
}

/// Of one kind of measurement.
struct Component {
  double cost = 0.0;  // in the file's units
  double redundancy = 0.0;

  double evidence(double scale) const {
    return -0.5 * (cost / scale + redundancy * std::log(scale)) + log_scale_prior(scale);
  }

  double likeliest(double before) const {
    return redundancy < 1.0 || !(cost > 0.0) ? before : drawn_in(cost / redundancy, redundancy);
  }
};

/// Of a loop.
struct Residual {
  double chi2() const { return translation + rotation; }

  double translation = 0.0;  // parts of chi-squared, in the file's units
  double rotation = 0.0;
  double redundancy = 0.0;
  double weight = 1.0;
};

template <class Pose>
std::vector<Residual> residuals_of(const Assessment<Pose>& assessment,
                                   const Explanation<Pose>& explanation) {
  std::vector<Residual> residuals;
  for (std::size_t k = 0; k < explanation.accepted.size(); ++k) {
    const auto& loop = assessment.graph().loops[k];
    if (!explanation.accepted[k] || loop.a == loop.b) continue;
    const typename Pose::Tangent r = assessment.estimate().residual(loop);
    const typename Pose::Tangent chi2 = r.cwiseProduct(loop.information * r);
    const double translation = chi2.template head<Pose::kDim>().sum();
    residuals.push_back({translation, chi2.sum() - translation,
                         assessment.redundancy(explanation, static_cast<Index>(k)).sum(),
                         explanation.weights[k]});
  }
  return residuals;
}

// A residual counts as far as it is redundant: the rest of it was fitted.
ScaleShares likeliest_shares(const std::vector<Residual>& residuals, double scale, int dof) {
  ScaleShares shares;
  for (int k = 0; k < kRepetitions; ++k) {
    const ScaleMixture mixture = expected_mixture(scale, shares);
    shares = {};
    for (const Residual& residual : residuals) {
      const ErrorScale error = error_scale(mixture, residual.chi2() / scale, residual.redundancy);
      for (std::size_t j = 0; j < kScaleCount; ++j) {
        shares.loops[j] += error.probability[j] * residual.redundancy / dof;
      }
    }
  }
  return shares;
}

double log_likelihood(const ScaleMixture& mixture, const std::vector<Residual>& residuals) {
  double sum = log_scale_prior(mixture.scale);
  for (const Residual& residual : residuals) {
    const double chi2 = residual.chi2() / mixture.scale;
    const ErrorScale error = error_scale(mixture, chi2, residual.redundancy);
    sum += error.evidence -
           0.5 * (error.weight * chi2 + residual.redundancy * std::log(mixture.scale));
    for (std::size_t j = 0; j < kScaleCount; ++j) {
      sum += error.probability[j] * mixture.log_share[j];
    }
  }
  return sum;
}

// The ratio of rotation's scale to translation's under which the loops are likeliest.
double likeliest_ratio(const std::vector<Residual>& residuals, const Redundancy& redundancy,
                       double before) {
  double translation = 0.0;
  double rotation = 0.0;
  for (const Residual& residual : residuals) {
    translation += residual.weight * residual.translation;
    rotation += residual.weight * residual.rotation;
  }
  const bool known = redundancy.translation >= 1.0 && redundancy.rotation >= 1.0 &&
                     translation > 0.0 && rotation > 0.0;
  if (!known) return before;
  return drawn_in(
      before * (rotation / redundancy.rotation) / (translation / redundancy.translation),
      redundancy.ratio());
}

}  // namespace

template <class Pose>
Lesson learn(const Assessment<Pose>& assessment, const Explanation<Pose>& explanation) {
  const CovarianceScale& before = explanation.scale;
  const Redundancy& redundancy = explanation.redundancy;
  auto residuals = residuals_of(assessment, explanation);
  const double fit_before =
      log_likelihood(expected_mixture(before.loops, explanation.shares), residuals);

  Lesson lesson{.rotation = likeliest_ratio(residuals, redundancy, explanation.rotation)};
  const PartScales<Pose> parts(lesson.rotation / explanation.rotation);
  Component loops = {0.0, redundancy.loops()};
  for (Residual& residual : residuals) {
    residual.translation /= parts.translation;
    residual.rotation /= parts.rotation;
    loops.cost += residual.weight * residual.chi2();
  }
  const Component odometry = {assessment.estimate().odometry_cost(), redundancy.odometry};
  lesson.scale = {odometry.likeliest(before.odometry), loops.likeliest(before.loops)};
  lesson.shares = likeliest_shares(residuals, lesson.scale.loops, Pose::kDof);
  lesson.gain = odometry.evidence(lesson.scale.odometry) - odometry.evidence(before.odometry) +
                log_likelihood(expected_mixture(lesson.scale.loops, lesson.shares), residuals) -
                fit_before -
                0.5 * (redundancy.translation * std::log(parts.translation) +
                       redundancy.rotation * std::log(parts.rotation)) +
                log_scale_prior(lesson.rotation) - log_scale_prior(explanation.rotation);
  return lesson;
}

template Lesson learn(const Assessment<Pose2>&, const Explanation<Pose2>&);
template Lesson learn(const Assessment<Pose3>&, const Explanation<Pose3>&);

}  // namespace isotherm::slam::detail
