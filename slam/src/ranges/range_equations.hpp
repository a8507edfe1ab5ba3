#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "graph/gauge.hpp"
#include "isotherm/slam/graph/range_graph.hpp"
#include "optimize/normal_equations.hpp"
#include "ranges/range_model.hpp"

namespace isotherm::slam::detail {

/// A range between two vertices that are part of an estimate.
struct RangeTerm {
  Index from = 0;
  Index to = 0;
  double distance = 0.0;  ///< metres, as measured
  double sigma = 0.0;     ///< as stated, > 0
  Index range = 0;        ///< its place among all ranges
};

/// What is estimated together.
template <class Pose>
struct RangeProblem {
  PoseGraph<Pose> steps;       ///< `constraints` between vertices that take part
  std::vector<bool> is_point;  ///< one a vertex
  Gauge gauge;                 ///< vertices that take no part, or are known, are held
  std::vector<RangeTerm> terms;
  double longest = 1.0;         ///< metres: no range is longer, and no offset
  double typical_excess = 1.0;  ///< metres: of a range that is too long, to begin with
  bool too_long = true;         ///< whether ranges can be too long
  bool calibrated = true;       ///< whether offset and stretch are known; else they are estimated
};

/// What is estimated: poses, and how ranges come about.
template <class Pose>
struct RangeEstimate {
  std::vector<Pose> poses;
  RangeModel model;
};

/// Measured less predicted.
template <class Pose>
double range_error(const RangeTerm& term, const RangeEstimate<Pose>& at);

/// The Gauss-Newton system of steps and ranges: that of the steps' NormalEquations with a term for
/// each range, bordered by offset and stretch where these are estimated.
///
/// A range of kind k has -log density with derivatives by the error; the sum over kinds is bounded
/// above by one whose kinds are as likely as they are here (EM), which is convex in the error and
/// gives the curvature.
template <class Pose>
class RangeEquations {
 public:
  /// `problem` must outlive this object.
  explicit RangeEquations(const RangeProblem<Pose>& problem,
                          spectral::FactorForm form = spectral::FactorForm::fastest);

  /// -log of the joint density of steps, ranges and the model's priors, up to a constant. O(m).
  double cost(const RangeEstimate<Pose>& at) const;

  /// Squared Mahalanobis distances of the steps, as stated. O(m).
  double steps_chi2(const RangeEstimate<Pose>& at) const;

  /// Sets the system up.
  void linearise(const RangeEstimate<Pose>& at);

  Eigen::VectorXd damping_scale() const;

  /// Solves with this much damping and moves. The decrease that the model of the system promises,
  /// or nothing where it cannot be solved.
  std::optional<double> move(double damping, const Eigen::VectorXd& scale, RangeEstimate<Pose>& at);

  /// log determinant of the whole system, offset and stretch included, but for what only keeps
  /// points from turning. After linearise(). Nothing where it is not definite.
  std::optional<double> log_determinant();

  /// Of each range, the variance of its prediction; after log_determinant(). The factor must be
  /// supernodal.
  std::vector<double> prediction_variances(const RangeEstimate<Pose>& at) const;

  /// Of each free vertex, the covariance of its perturbation; after log_determinant(), with a
  /// supernodal factor. Offset and stretch count as known.
  std::vector<typename Pose::Matrix> own_covariances() const;

  /// How many degrees of freedom the ranges' errors have lost to the estimate: the trace of the
  /// part of the system's inverse that is theirs. After linearise().
  double fitted(const std::vector<double>& variances) const;

  /// How many of the steps' numbers are left to tell how accurate they are, of which the ranges
  /// are fitted by so many: the traces of both parts sum to the number of unknowns.
  double steps_redundancy(double fitted) const;

  /// Of each range, 1 / m^2; after linearise().
  const std::vector<double>& curvatures() const noexcept { return curvature_; }

  const RangeProblem<Pose>& problem() const noexcept { return problem_; }

 private:
  void add_range(std::size_t k, const RangeEstimate<Pose>& at);

  const RangeProblem<Pose>& problem_;
  NormalEquations<Pose> equations_;
  // Offset and stretch, where estimated.
  Eigen::MatrixXd border_;
  Eigen::MatrixXd corner_;
  Eigen::VectorXd border_gradient_;
  std::vector<double> curvature_;
};

}  // namespace isotherm::slam::detail
