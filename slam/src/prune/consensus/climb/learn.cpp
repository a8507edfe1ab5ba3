#include "prune/consensus/climb/learn.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "matrices/decompositions.hpp"
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
  Tangent most = Tangent::Constant(kMostScale);  // of logs of the factors
  double steps = 0.0;                            // that vary by no more than that

  double evidence(const Tangent& logs) const {
    return -0.5 * (cost.dot((-logs).array().exp().matrix()) + redundancy.dot(logs)) +
           log_scale_peak(logs, redundancy) - log_excess(logs, most, steps);
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
    if (redundancy.sum() < 1.0 || !(cost.sum() > 0.0)) return before.cwiseMin(most);
    if (same_shapes) {
      const Tangent own = before.array() - before.mean();
      const double scale = drawn_in(cost.dot((-own).array().exp().matrix()), redundancy.sum());
      return (scale + own.array()).max(-kMostScale).min(most.array());
    }
    const double common = drawn_in(cost.sum(), redundancy.sum());
    const Tangent one = most.cwiseMin(std::max(common, -kMostScale));
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
    return logs.cwiseMax(logs.maxCoeff() - kMostApart).cwiseMax(-kMostScale).cwiseMin(most);
  }
};

/// Of a loop.
template <class Pose>
struct Residual {
  using Tangent = typename Pose::Tangent;

  double chi2() const { return parts.sum(); }

  // How much of it tells of the scale that is learnt: of one that errs as stated nothing.
  Tangent telling() const { return (1.0 - weight.stated) * redundancy; }

  Tangent parts;  // of chi-squared, by coordinate, in the file's units
  double stated;  // chi-squared, by what the file states
  Tangent redundancy;
  LoopWeight weight;
};

template <class Pose>
using Residuals = std::vector<Residual<Pose>>;

template <class Pose>
Residuals<Pose> residuals_of(const Assessment<Pose>& assessment,
                             const Explanation<Pose>& explanation) {
  Residuals<Pose> residuals;
  for (std::size_t k = 0; k < explanation.accepted.size(); ++k) {
    const auto loop = static_cast<Index>(k);
    const auto& link = assessment.graph().loops[k];
    if (!explanation.accepted[k] || link.a == link.b) continue;
    const auto& stated = assessment.objective().stated().reduced.loops[k];
    const typename Pose::Tangent r = assessment.belief(loop).r;
    residuals.push_back({r.cwiseProduct(link.information * r), r.dot(stated.information * r),
                         assessment.redundancy(explanation, loop), explanation.weights[k]});
  }
  return residuals;
}

/// What loops are expected to err by.
template <class Pose>
struct Accuracy {
  using Tangent = typename Pose::Tangent;

  ScaleMixture mixture() const { return expected_mixture(scale, shares, shape.minCoeff()); }
  Tangent logs() const { return log_scales(scale, shape); }

  double scale;
  Tangent shape;
  ScaleShares shares;
};

// A residual tells as far as it is redundant: the rest of it was fitted.
template <class Pose>
ErrorScale error_scale(const Residual<Pose>& residual, const ScaleMixture& mixture,
                       const typename Pose::Tangent& logs) {
  return detail::error_scale(mixture, {.chi2 = residual.chi2() / mixture.scale,
                                       .stated = residual.stated,
                                       .dof = residual.redundancy.sum(),
                                       .log_stated = -residual.redundancy.dot(logs)});
}

// Weighs them by what is expected of each; how many are of which scale then.
template <class Pose>
ScaleShares weigh(const Accuracy<Pose>& accuracy, Residuals<Pose>& residuals) {
  const ScaleMixture mixture = accuracy.mixture();
  const typename Pose::Tangent logs = accuracy.logs();
  ScaleShares shares;
  for (auto& residual : residuals) {
    const ErrorScale error = error_scale(residual, mixture, logs);
    residual.weight = error.weight;
    shares.add(error);
  }
  return shares;
}

// What they cost and tell, by coordinate, for the scale that is learnt.
template <class Pose>
Component<typename Pose::Tangent> component_of(const Residuals<Pose>& residuals) {
  using Tangent = typename Pose::Tangent;
  Component<Tangent> loops{.cost = Tangent::Zero(), .redundancy = Tangent::Zero()};
  for (const auto& residual : residuals) {
    loops.cost += residual.weight.learnt * residual.parts;
    loops.redundancy += residual.telling();
  }
  return loops;
}

// The likeliest, and residuals weighed by them, at a scale of most that is learnt with them.
template <class Pose>
ScaleShares likeliest_from(Accuracy<Pose> accuracy, Residuals<Pose>& residuals) {
  for (int k = 0; k < kRepetitions; ++k) {
    accuracy.shares = weigh(accuracy, residuals);
    const auto loops = component_of(residuals);
    const double log_scale = drawn_in(loops.cost.sum(), loops.redundancy.sum());
    accuracy.scale = std::exp(std::clamp(log_scale, -kMostScale, kMostScale));
  }
  return accuracy.shares;
}

// With all shares integrated out, and the peak of the scale as wide as these residuals leave it, as
// the objective has it.
template <class Pose>
double log_likelihood(const Accuracy<Pose>& accuracy, const Residuals<Pose>& residuals) {
  const ScaleMixture mixture = accuracy.mixture();
  const typename Pose::Tangent logs = accuracy.logs();
  typename Pose::Tangent telling = Pose::Tangent::Zero();
  double sum = 0.0;
  ScaleShares found;
  for (const auto& residual : residuals) {
    const ErrorScale error = error_scale(residual, mixture, logs);
    const auto& [learnt, stated] = error.weight;
    sum += error.evidence - 0.5 * (learnt * residual.chi2() / mixture.scale +
                                   stated * residual.stated + residual.redundancy.dot(logs));
    telling += (1.0 - stated) * residual.redundancy;
    found.add(error);
  }
  return sum + found.log_evidence() + log_scale_peak(logs, telling);
}

// By coordinate, or where correlations leave one of them a negative cost by part.
template <class Pose>
Component<typename Pose::Tangent> told_apart(const Component<typename Pose::Tangent>& component) {
  return component.cost.minCoeff() < 0.0 ? component.by_part(Pose::kDim) : component;
}

// What odometry tells of its own; loops as they are.
template <class Pose>
Lesson<Pose> of_odometry(const Explanation<Pose>& explanation, const Objective<Pose>& objective,
                         bool same_shapes) {
  using Tangent = typename Pose::Tangent;
  const auto& [scale, shapes] = std::tie(explanation.scale, explanation.shapes);
  const Component<Tangent> odometry{explanation.odometry_cost.cwiseProduct(shapes.odometry),
                                    explanation.redundancy.odometry, objective.most_odometry(),
                                    objective.odometry_count()};
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
                      Residuals<Pose> residuals, bool same_shapes, Lesson<Pose> lesson) {
  using Tangent = typename Pose::Tangent;
  const double scale = explanation.scale.loops;
  const Tangent& shape = explanation.shapes.loops;
  const ScaleShares shares =
      likeliest_from<Pose>({scale * start.factor, shape, start.shares}, residuals);
  Component<Tangent> loops = component_of(residuals);
  loops.cost = loops.cost.cwiseProduct(shape);
  const Tangent now = told_apart<Pose>(loops).likeliest(log_scales(scale, shape), same_shapes);
  std::tie(lesson.scale.loops, lesson.shapes.loops) = scale_and_shape(now);
  const Tangent change = lesson.shapes.loops.cwiseQuotient(shape);
  for (auto& residual : residuals) residual.parts = residual.parts.cwiseQuotient(change);
  Accuracy<Pose> found{lesson.scale.loops, lesson.shapes.loops, shares};
  found.shares = lesson.shares = weigh(found, residuals);
  lesson.gain += log_likelihood(found, residuals);
  return lesson;
}

}  // namespace

template <class Pose>
Lesson<Pose> learn(const Assessment<Pose>& assessment, const Explanation<Pose>& explanation,
                   bool same_shapes) {
  const auto residuals = residuals_of(assessment, explanation);
  const ScaleShares& shares = explanation.shares;
  const double before =
      log_likelihood<Pose>({explanation.scale.loops, explanation.shapes.loops, shares}, residuals);
  const Lesson<Pose> odometry = of_odometry(explanation, assessment.objective(), same_shapes);
  Lesson<Pose> best = odometry;
  for (const ScaleShift& start :
       {ScaleShift{1.0, shares}, wider_most(shares), sharper_most(shares)}) {
    auto lesson = of_loops(start, explanation, residuals, same_shapes, odometry);
    lesson.gain -= before;
    if (lesson.gain > best.gain) best = lesson;
  }
  return best;
}

template Lesson<Pose2> learn(const Assessment<Pose2>&, const Explanation<Pose2>&, bool);
template Lesson<Pose3> learn(const Assessment<Pose3>&, const Explanation<Pose3>&, bool);

}  // namespace isotherm::slam::detail
