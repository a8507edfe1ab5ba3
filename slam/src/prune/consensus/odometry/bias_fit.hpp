#pragma once

#include <span>
#include <vector>

#include "prune/consensus/estimate/belief.hpp"
#include "prune/consensus/estimate/estimate.hpp"
#include "prune/consensus/odometry/turn_bias.hpp"

namespace isotherm::slam::detail {

/// What a fit of odometry's bias starts from: the derivatives of contracted steps by it, of which
/// there may be fewer than steps, the value it is held at, and its variance before anything was
/// measured.
template <class Pose>
struct BiasPrior {
  std::span<const ByBias<Pose>> by_bias;
  TurnBias<Pose> now;
  TurnBias<Pose> variance;
};

/// What measurements tell of a bias that was held at some value while the poses were found: to
/// first order poses follow it, as the least-squares problem at the factor has it with the bias for
/// one more variable (Schur's complement).
template <class Pose>
class BiasFit {
 public:
  using Bias = TurnBias<Pose>;
  using Matrix = typename Pose::Matrix;

  /// At the last update of `estimate`, on `graph`, where the factor on odometry's covariances was
  /// `scale`. Both must outlive this object. O(steps).
  BiasFit(const Estimate<Pose>& estimate, const ReducedGraph<Pose>& graph,
          const BiasPrior<Pose>& prior, double scale);

  /// Of the highest evidence.
  Bias likeliest() const { return root_.cwiseProduct(likeliest_); }

  /// What that one gains against the one that was held, in nats.
  double gain() const;

  /// log of the evidence of the one that was held, integrated around the likeliest, against that
  /// of none where it is known.
  double log_evidence() const;

  /// What a residual is more with the likeliest, and its covariance for not knowing it: of a loop,
  /// and of a step by its number.
  Belief<Pose> of_loop(const Link<Pose>& loop) const { return carried(moved(loop)); }
  Belief<Pose> of_step(std::size_t step) const;

  /// Of the free poses, as it changes by so much.
  Eigen::VectorXd moves(const Bias& change) const { return moves_ * change; }

  /// As it differs from the likeliest by so many deviations.
  Bias drawn(const Bias& deviations) const;

 private:
  using Square = Eigen::Matrix<double, Bias::SizeAtCompileTime, Bias::SizeAtCompileTime>;

  ByBias<Pose> moved(const Link<Pose>& link) const;
  Belief<Pose> carried(const ByBias<Pose>& by) const;

  const Estimate<Pose>& estimate_;
  const ReducedGraph<Pose>& graph_;
  Bias root_;  // of the variance before
  Bias now_;   // this and the next in units of root_
  Bias likeliest_;
  Square precision_;                  // with the prior
  std::vector<ByBias<Pose>> direct_;  // of residuals of steps, where the poses stay
  Eigen::MatrixXd moves_;             // of the free poses, a column a coordinate
};

extern template class BiasFit<Pose2>;
extern template class BiasFit<Pose3>;

}  // namespace isotherm::slam::detail
