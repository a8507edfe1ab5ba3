#include "prune/consensus/climb/learn.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "prune/consensus/objective/scale_prior.hpp"

namespace isotherm::slam::detail {
namespace {

// Of a coordinate against the others: a deviation of the prior. Contracted odometry is no longer
// linear within deviations that are farther apart.
constexpr double kMostOwn = kScaleDeviation;
constexpr double kLeastRedundancy = 1e-6;  // less is rounding
constexpr int kRepetitions = 10;           // of expectation maximisation

// The log of the likeliest factor on variances of this cost and redundancy, to first order about
// cost over redundancy, drawn towards zero by the prior. Of nothing redundant nothing is told.
double drawn_in(double cost, double redundancy) {
  if (redundancy < kLeastRedundancy) return 0.0;
  const double precision = 0.5 * redundancy;
  const double least = -2.0 * kMostScale;
  const double peak = cost > 0.0 ? std::max(std::log(cost / redundancy), least) : least;
  return peak * precision / (precision + 1.0 / (kScaleDeviation * kScaleDeviation));
}

/// Measurements of one kind, by coordinate.
template <class Tangent>
struct Component {
  Tangent cost;  // in the file's units
  Tangent redundancy;

  double evidence(const Tangent& logs) const {
    return -0.5 * (cost.dot((-logs).array().exp().matrix()) + redundancy.dot(logs)) +
           log_scale_peak(logs, redundancy);
  }

  // The same with each coordinate's the mean of its part, translation or rotation.
  Component by_part(int dimensions) const {
    const auto turns = cost.size() - dimensions;
    Component parts = *this;
    for (Tangent* of : {&parts.cost, &parts.redundancy}) {
      of->head(dimensions).setConstant(of->head(dimensions).mean());
      of->tail(turns).setConstant(of->tail(turns).mean());
    }
    return parts;
  }

  // Logs of the factors where the evidence has its peak. Correlated coordinates have their cost
  // together: where one's is negative it cannot be told apart.
  Tangent likeliest(const Tangent& before, bool same_shapes) const {
    if (redundancy.sum() < 1.0 || !(cost.sum() > 0.0)) return before;
    if (same_shapes) {
      const Tangent own = before.array() - before.mean();
      const double scale = drawn_in(cost.dot((-own).array().exp().matrix()), redundancy.sum());
      return (scale + own.array()).max(-kMostScale).min(kMostScale);
    }
    const double common = drawn_in(cost.sum(), redundancy.sum());
    const Tangent one = Tangent::Constant(std::clamp(common, -kMostScale, kMostScale));
    if (cost.minCoeff() < 0.0) return one;
    const Tangent each = by_coordinate();
    return evidence(each) > evidence(one) ? each : one;
  }

 private:
  // A factor of all coordinates and one of each take turns. One that is as small as it may be tells
  // nothing of the others: across the floor that a robot drives on, nothing is measured.
  Tangent by_coordinate() const {
    double common = 0.0;
    Tangent own = Tangent::Zero();
    for (int k = 0; k < kRepetitions; ++k) {
      const Tangent telling = (own.array() > -kMostOwn).template cast<double>();
      common = drawn_in(cost.cwiseProduct(telling).dot((-own).array().exp().matrix()),
                        redundancy.dot(telling));
      for (Eigen::Index d = 0; d < own.size(); ++d) {
        const double likeliest = drawn_in(cost[d] * std::exp(-common), redundancy[d]);
        own[d] = std::clamp(likeliest, -kMostOwn, kMostOwn);
      }
    }
    return (common + own.array()).max(-kMostScale).min(kMostScale);
  }
};

/// Of a loop.
template <class Pose>
struct Residual {
  double chi2() const { return parts.sum(); }

  typename Pose::Tangent parts;  // of chi-squared, by coordinate, in the file's units
  double redundancy = 0.0;
  double weight = 1.0;
};

template <class Pose>
std::vector<Residual<Pose>> residuals_of(const Assessment<Pose>& assessment,
                                         const Explanation<Pose>& explanation) {
  std::vector<Residual<Pose>> residuals;
  for (std::size_t k = 0; k < explanation.accepted.size(); ++k) {
    const auto& loop = assessment.graph().loops[k];
    if (!explanation.accepted[k] || loop.a == loop.b) continue;
    const typename Pose::Tangent r = assessment.estimate().residual(loop);
    residuals.push_back({r.cwiseProduct(loop.information * r),
                         assessment.redundancy(explanation, static_cast<Index>(k)).sum(),
                         explanation.weights[k]});
  }
  return residuals;
}

// Weighs them by what is expected of each; how many are of which scale then. A residual counts as
// far as it is redundant: the rest of it was fitted.
template <class Pose>
ScaleShares weigh(const ScaleMixture& mixture, std::vector<Residual<Pose>>& residuals) {
  ScaleShares shares;
  for (auto& residual : residuals) {
    const double chi2 = residual.chi2() / mixture.scale;
    const ErrorScale error = error_scale(mixture, chi2, residual.redundancy);
    residual.weight = error.weight;
    shares.add(error, residual.redundancy / Pose::kDof);
  }
  return shares;
}

// The likeliest, and residuals weighed by them, at a scale of most that is learnt with them.
template <class Pose>
ScaleShares likeliest_from(const ScaleShift& start, double scale,
                           std::vector<Residual<Pose>>& residuals) {
  ScaleShares shares = start.shares;
  double log_scale = std::log(scale * start.factor);
  double redundancy = 0.0;
  for (const auto& residual : residuals) redundancy += residual.redundancy;
  for (int k = 0; k < kRepetitions; ++k) {
    shares = weigh(expected_mixture(std::exp(log_scale), shares), residuals);
    double cost = 0.0;
    for (const auto& residual : residuals) cost += residual.weight * residual.chi2();
    log_scale = std::clamp(drawn_in(cost, redundancy), -kMostScale, kMostScale);
  }
  return shares;
}

// With all shares integrated out, as Objective::evidence() has it.
template <class Pose>
double log_likelihood(const ScaleMixture& mixture, const std::vector<Residual<Pose>>& residuals) {
  double sum = 0.0;
  ScaleShares found;
  for (const auto& residual : residuals) {
    const double chi2 = residual.chi2() / mixture.scale;
    const ErrorScale error = error_scale(mixture, chi2, residual.redundancy);
    sum += error.evidence - 0.5 * error.weight * chi2;
    found.add(error);
  }
  return sum + found.log_evidence();
}

// By coordinate, or where correlations leave one of them a negative cost by part.
template <class Pose>
Component<typename Pose::Tangent> told_apart(const Component<typename Pose::Tangent>& component) {
  return component.cost.minCoeff() < 0.0 ? component.by_part(Pose::kDim) : component;
}

template <class Tangent>
std::pair<double, Tangent> scale_and_shape(const Tangent& logs) {
  return {std::exp(logs.mean()), (logs.array() - logs.mean()).exp()};
}

// From this scale called that of most, with these residuals of loops; what they gain is not yet
// against how likely they were before.
template <class Pose>
Lesson<Pose> lesson_from(const ScaleShift& start, const Explanation<Pose>& explanation,
                         std::vector<Residual<Pose>> residuals, bool same_shapes) {
  using Tangent = typename Pose::Tangent;
  const auto& [scale, shapes, redundancy] =
      std::tie(explanation.scale, explanation.shapes, explanation.redundancy);
  Lesson<Pose> lesson;
  lesson.shares = likeliest_from(start, scale.loops, residuals);
  Tangent loops_cost = Tangent::Zero();
  for (const auto& residual : residuals) loops_cost += residual.weight * residual.parts;
  const Component<Tangent> odometry{explanation.odometry_cost.cwiseProduct(shapes.odometry),
                                    redundancy.odometry};
  const Component<Tangent> loops{loops_cost.cwiseProduct(shapes.loops), redundancy.loops};
  const Tangent odometry_before = log_scales(scale.odometry, shapes.odometry);
  const Tangent loops_before = log_scales(scale.loops, shapes.loops);
  const Tangent odometry_now = told_apart<Pose>(odometry).likeliest(odometry_before, same_shapes);
  const Tangent loops_now = told_apart<Pose>(loops).likeliest(loops_before, same_shapes);

  std::tie(lesson.scale.odometry, lesson.shapes.odometry) = scale_and_shape(odometry_now);
  std::tie(lesson.scale.loops, lesson.shapes.loops) = scale_and_shape(loops_now);
  lesson.gain = odometry.evidence(odometry_now) - odometry.evidence(odometry_before) +
                log_scale_peak(loops_now, redundancy.loops) -
                log_scale_peak(loops_before, redundancy.loops) -
                0.5 * redundancy.loops.dot(loops_now - loops_before);
  const Tangent change = lesson.shapes.loops.cwiseQuotient(shapes.loops);
  for (auto& residual : residuals) residual.parts = residual.parts.cwiseQuotient(change);
  const ScaleMixture mixture = expected_mixture(lesson.scale.loops, lesson.shares);
  lesson.shares = weigh(mixture, residuals);
  lesson.gain += log_likelihood(expected_mixture(lesson.scale.loops, lesson.shares), residuals);
  return lesson;
}

}  // namespace

template <class Pose>
Lesson<Pose> learn(const Assessment<Pose>& assessment, const Explanation<Pose>& explanation,
                   bool same_shapes) {
  const auto residuals = residuals_of(assessment, explanation);
  const ScaleShares& shares = explanation.shares;
  Lesson<Pose> best = lesson_from({1.0, shares}, explanation, residuals, same_shapes);
  for (const ScaleShift& other : {wider_most(shares), sharper_most(shares)}) {
    const auto lesson = lesson_from(other, explanation, residuals, same_shapes);
    if (lesson.gain > best.gain) best = lesson;
  }
  best.gain -= log_likelihood(expected_mixture(explanation.scale.loops, shares), residuals);
  return best;
}

template <class Pose>
double most_gain_of_wider(double factor, const Assessment<Pose>& assessment,
                          const Explanation<Pose>& explanation) {
  double cost = assessment.estimate().odometry_cost() / explanation.scale.odometry;
  double redundancy = 0.0;
  for (const auto& residual : residuals_of(assessment, explanation)) {
    cost += residual.weight * residual.chi2() / explanation.scale.loops;
    redundancy += residual.redundancy;
  }
  return 0.5 * ((1.0 - 1.0 / factor) * cost - redundancy * std::log(factor));
}

template Lesson<Pose2> learn(const Assessment<Pose2>&, const Explanation<Pose2>&, bool);
template double most_gain_of_wider(double, const Assessment<Pose2>&, const Explanation<Pose2>&);
template Lesson<Pose3> learn(const Assessment<Pose3>&, const Explanation<Pose3>&, bool);
template double most_gain_of_wider(double, const Assessment<Pose3>&, const Explanation<Pose3>&);

}  // namespace isotherm::slam::detail
