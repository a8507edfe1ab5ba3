#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "optimize/normal_equations.hpp"
#include "prune/consensus/covariance_scale.hpp"
#include "prune/consensus/estimate/pace.hpp"
#include "prune/consensus/estimate/reduced_graph.hpp"

namespace isotherm::slam::detail {

/// The poses of a reduced graph given odometry and the accepted loops, and the
/// factor of the normal equations there, from which covariances are read.
template <class Pose>
class Estimate {
 public:
  using Matrix = typename Pose::Matrix;
  using Tangent = typename Pose::Tangent;

  /// `graph` must outlive this object. Starts at odometry.
  explicit Estimate(const ReducedGraph<Pose>& graph, Pace pace = {});

  /// The same poses on the same graph with other covariances; update() must follow.
  void use(const ReducedGraph<Pose>& graph);

  /// Gauss-Newton from the present poses, on odometry and the loops whose
  /// `accepted` entry is true. Parts of the graph that a loop joins for the first
  /// time are first moved to where it says. Ends once steps stop mattering
  /// against the covariances, or after `max_steps`.
  /// @throws NumericalError if the normal equations break down
  void update(const std::vector<bool>& accepted, const CovarianceScale& scale, int max_steps);

  /// The same, until weights settle too: whenever poses nearly have, `reweigh` may call
  /// weigh_loops(), and says whether it did.
  void settle(const std::vector<bool>& accepted, const CovarianceScale& scale, int max_steps,
              const std::function<bool()>& reweigh);

  /// From the next step on the information of each loop, in place of the graph's over its scale.
  void weigh_loops(std::vector<Matrix> information) { information_ = std::move(information); }

  const std::vector<Pose>& poses() const noexcept { return poses_; }

  /// Moves of the free poses, a column each, drawn from those that odometry and the accepted loops
  /// leave possible: by their joint covariance after an update at this scale. Always the same
  /// draws, that change little with the loops accepted: the errors of each link are the same.
  Eigen::MatrixXd drawn(const CovarianceScale& scale, std::size_t count) const;

  /// Where the poses are, without the factor there.
  struct Layout {
    std::vector<Pose> poses;
    std::vector<Index> component;
  };
  Layout layout() const { return {poses_, component_}; }

  /// Takes poses back to where they were; update() must follow.
  void restore(Layout layout);

  /// log(T_measured^-1 T_a^-1 T_b): after an update that of the least-squares problem linearised
  /// where its factor was formed, so that both agree to rounding. Where little but a loop itself
  /// measures, what is left of its residual is a small part of what others would leave.
  Tangent residual(const Link<Pose>& link) const;

  /// Numbers of the components that the ends of a loop lie on: the same where trusted and accepted
  /// links join them.
  std::pair<Index, Index> parts(const Link<Pose>& loop) const;

  /// Of a residual, by the poses at its ends.
  struct Derivative {
    Tangent residual;
    Matrix by_a;
    Matrix by_b;
  };

  /// Where the factor was formed.
  Derivative derivative(const Link<Pose>& link) const;

  /// Whether links of odometry and of the accepted loops are others than on that layout, by as many
  /// deviations (root mean square) as matter.
  bool differs_from(const Layout& layout, const CovarianceScale& scale) const;

  /// Takes poses to the chordal relaxation of odometry and the accepted loops, which does not
  /// depend on where they are: Gauss-Newton ends at the nearest of what may be many minima (L.
  /// Carlone et al., "Initialization Techniques for 3D SLAM", ICRA 2015); update() must follow.
  void lay_out_anew(const std::vector<bool>& accepted, const CovarianceScale& scale);

  /// The map where the free poses have moved by so much, composed along odometry: each step changes
  /// as its ends' moves say to first order. However far these are, steps that they change by little
  /// stay whole; poses that move each by itself tear apart what turns with them.
  std::vector<Pose> moved(const Eigen::VectorXd& moves) const;

  /// Moves the free poses as moved(); update() must follow.
  void follow(const Eigen::VectorXd& moves);

  using Links = std::vector<const Link<Pose>*>;

  /// Covariances of the residuals of `links` where the factor of the last update was formed, then
  /// of those of `bounded` what they are at most however their ends are correlated, which takes
  /// less time; found on `threads` threads (0: all cores). The ends of each must be connected.
  std::vector<Matrix> residual_covariances(const Links& links, int threads = 1,
                                           const Links& bounded = {}) const;

  /// r' Omega r summed over odometry, in units of the graph's covariances.
  double odometry_cost() const;

  /// log|H|, of the factor of the last update.
  double log_determinant() const { return equations_->hessian().log_determinant(); }

  /// Whether nothing has changed since the last update.
  bool is_factorised() const noexcept { return factorised_; }

  /// What was factorised by the last update; its variables are those of gauge().
  const spectral::BlockCholesky& factor() const { return equations_->hessian(); }
  const Gauge& gauge() const { return equations_->gauge(); }

  /// What linearising and factorising takes, as Pace counts it.
  double work() const;

  /// Number of poses that are free, as of the last update.
  Index variable_count() const { return equations_->hessian().block_count(); }

 private:
  void lay_out(const std::vector<bool>& accepted);
  Matrix loop_information(std::size_t used, const CovarianceScale& scale) const;
  void add_errors(const Link<Pose>& link, const Matrix& information,
                  std::span<const Tangent> errors, Eigen::MatrixXd& gradients) const;
  void linearize(const CovarianceScale& scale);
  void factorise();
  Eigen::VectorXd next_move();
  double step();
  struct AtFactor;
  AtFactor at_factor(const Link<Pose>& link) const;
  PoseGraph<Pose> used_links(const std::vector<bool>& accepted);
  void join_components(const PoseGraph<Pose>& used);

  const ReducedGraph<Pose>* graph_;
  std::vector<Pose> poses_;
  std::vector<Pose> linearized_;  // poses where the factor was formed
  Eigen::VectorXd move_;          // from there to poses_; empty without a factor
  std::vector<Index> component_;
  std::vector<bool> laid_out_for_;   // loops that the equations hold, after all steps
  std::vector<Index> used_loops_;    // of laid_out_for_, those between different nodes
  std::vector<Matrix> information_;  // of loops; the graph's where empty
  std::optional<NormalEquations<Pose>> equations_;
  bool has_factor_ = false;  // the equations have one, if of other poses or information
  bool factorised_ = false;  // it is of these
  Pace pace_;                // whenever the equations were set up
};

/// The part of log(T_measured^-1 T) that changes with T: J with
/// log(T_measured^-1 T exp(d)) = r + J d to first order.
template <class Pose>
typename Pose::Matrix residual_jacobian(const typename Pose::Tangent& r) {
  return Pose::right_jacobian_inverse(r);
}

extern template class Estimate<Pose2>;
extern template class Estimate<Pose3>;

}  // namespace isotherm::slam::detail
