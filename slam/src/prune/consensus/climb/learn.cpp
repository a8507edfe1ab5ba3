#include "prune/consensus/climb/learn.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include "prune/consensus/constants.hpp"
#include "prune/consensus/objective/scale_prior.hpp"

namespace isotherm::slam::detail {
namespace {

// Of logs of two coordinates' factors, each a deviation of the prior from the common one.
// Contracted odometry is no longer linear within deviations that are farther apart, and where
// nothing is measured (across the floor that a robot drives on) factors are as small as they may
// be.
constexpr double kMostApart = 2.0 * kScaleDeviation;
constexpr double kLeastRedundancy = 1e-6;  // less is rounding
constexpr int kRepetitions = 10;           // of expectation maximisation, and of Newton's steps

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
  using Precision = Eigen::Matrix<double, Tangent::SizeAtCompileTime, Tangent::SizeAtCompileTime>;

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
  // Newton's method on what evidence() says, which is concave, from cost over redundancy.
  Tangent by_coordinate() const {
    Tangent logs;
    for (Eigen::Index d = 0; d < logs.size(); ++d) logs[d] = drawn_in(cost[d], redundancy[d]);
    const Precision prior = prior_precision<Tangent>();
    for (int k = 0; k < kRepetitions; ++k) {
      const Tangent fitted = 0.5 * cost.cwiseProduct((-logs).array().exp().matrix());
      const Tangent gradient = fitted - 0.5 * redundancy - prior * logs;
      const Precision curvature = prior + Precision(fitted.asDiagonal());
      logs += curvature.llt().solve(gradient).cwiseMax(-1.0).cwiseMin(1.0);
    }
    return logs.cwiseMax(logs.maxCoeff() - kMostApart).cwiseMax(-kMostScale).cwiseMin(kMostScale);
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

// Weighs them by what is expected of each; how many are of which scale then. A residual tells as
// far as it is redundant: the rest of it was fitted.
template <class Pose>
ScaleShares weigh(const ScaleMixture& mixture, std::vector<Residual<Pose>>& residuals) {
  ScaleShares shares;
  for (auto& residual : residuals) {
    const double chi2 = residual.chi2() / mixture.scale;
    const ErrorScale error = error_scale(mixture, chi2, residual.redundancy);
    residual.weight = error.weight;
    shares.add(error);
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

// What odometry tells of its own; loops as they are.
template <class Pose>
Lesson<Pose> of_odometry(const Explanation<Pose>& explanation, bool same_shapes) {
  using Tangent = typename Pose::Tangent;
  const auto& [scale, shapes] = std::tie(explanation.scale, explanation.shapes);
  const Component<Tangent> odometry{explanation.odometry_cost.cwiseProduct(shapes.odometry),
                                    explanation.redundancy.odometry};
  const Tangent before = log_scales(scale.odometry, shapes.odometry);
  const Tangent now = told_apart<Pose>(odometry).likeliest(before, same_shapes);
  Lesson<Pose> lesson{scale, shapes, explanation.shares};
  const double gain = odometry.evidence(now) - odometry.evidence(before);
  if (gain <= 0.0) return lesson;
  lesson.gain = gain;
  std::tie(lesson.scale.odometry, lesson.shapes.odometry) = scale_and_shape(now);
  return lesson;
}

// What loops with these residuals tell of their own, from this scale called that of most, beside
// `lesson`; what they gain is not yet against how likely they were before.
template <class Pose>
Lesson<Pose> of_loops(const ScaleShift& start, const Explanation<Pose>& explanation,
                      std::vector<Residual<Pose>> residuals, bool same_shapes,
                      Lesson<Pose> lesson) {
  using Tangent = typename Pose::Tangent;
  const double scale = explanation.scale.loops;
  const Tangent& shape = explanation.shapes.loops;
  const Tangent& redundancy = explanation.redundancy.loops;
  lesson.shares = likeliest_from(start, scale, residuals);
  Tangent cost = Tangent::Zero();
  for (const auto& residual : residuals) cost += residual.weight * residual.parts;
  const Component<Tangent> loops{cost.cwiseProduct(shape), redundancy};
  const Tangent before = log_scales(scale, shape);
  const Tangent now = told_apart<Pose>(loops).likeliest(before, same_shapes);
  std::tie(lesson.scale.loops, lesson.shapes.loops) = scale_and_shape(now);
  lesson.gain += log_scale_peak(now, redundancy) - log_scale_peak(before, redundancy) -
                 0.5 * redundancy.dot(now - before);
  const Tangent change = lesson.shapes.loops.cwiseQuotient(shape);
  for (auto& residual : residuals) residual.parts = residual.parts.cwiseQuotient(change);
  const auto mixture = [&] { return expected_mixture(lesson.scale.loops, lesson.shares); };
  lesson.shares = weigh(mixture(), residuals);
  lesson.gain += log_likelihood(mixture(), residuals);
  return lesson;
}

}  // namespace

template <class Pose>
Lesson<Pose> learn(const Assessment<Pose>& assessment, const Explanation<Pose>& explanation,
                   bool same_shapes) {
  const auto residuals = residuals_of(assessment, explanation);
  const ScaleShares& shares = explanation.shares;
  const double before = log_likelihood(explanation.mixture(), residuals);
  const Lesson<Pose> odometry = of_odometry(explanation, same_shapes);
  Lesson<Pose> best = odometry;
  for (const ScaleShift& start :
       {ScaleShift{1.0, shares}, wider_most(shares), sharper_most(shares)}) {
    auto lesson = of_loops(start, explanation, residuals, same_shapes, odometry);
    lesson.gain -= before;
    if (lesson.gain > best.gain) best = lesson;
  }
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
