#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "isotherm/spectral/sparse/block_cholesky.hpp"
#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// What the other ranges say about one range.
struct RangeCheck {
  bool checked = false;  ///< both ends are placed
  double chi2 = 0.0;     ///< squared leave-one-out residual by its variance
  /// Leave-one-out residual by its standard deviation, measured less predicted: a
  /// biased range is positive.
  double deviation = 0.0;
  /// Part of the range's own information that the others also give, in [0, 1]: 0
  /// for a range that nothing can check.
  double redundancy = 0.0;

  /// Whether anything but the range itself speaks about its length.
  bool is_tested() const { return checked && redundancy > 1e-6; }
};

/// The information matrix of the placed nodes that are no anchors, given the ranges
/// in `use`, at their positions.
///
/// Without anchors the frame is held by the d + 1 nodes of a small simplex, whose
/// rigid motions are penalised; what does not depend on the frame is unaffected.
class RangeInformation {
 public:
  /// `unit_weights` counts every range alike, whatever its standard deviation; only
  /// redundancies of used ranges mean something then.
  RangeInformation(const RangeProblem& problem, const std::vector<bool>& use,
                   const Placement& placement, bool unit_weights = false);

  /// With this information, 1 / m^2, of each range in `use`, which must outlive this object.
  RangeInformation(const RangeProblem& problem, const std::vector<bool>& use,
                   const Placement& placement, const std::vector<double>& information);

  Index unknowns() const { return static_cast<Index>(matrix_.size()); }

  /// Leave-one-out tests of all ranges. One factorisation. @throws NumericalError
  std::vector<RangeCheck> check_ranges();

  /// Of each range between placed nodes, the variance of its prediction; of one that is hopelessly
  /// far off, a bound. One factorisation. @throws NumericalError
  std::vector<double> predicted_variances();

  /// Of the information matrix. One factorisation. @throws NumericalError
  double log_determinant();

  /// d x d a node, empty where not placed or an anchor. Without anchors those of the
  /// inner constraints: the covariance of the shape, of minimal trace.
  std::vector<Eigen::MatrixXd> covariances();

  /// Which unknown nodes can move without changing a range (one a node; false for
  /// those that are no unknowns), by how the inverse grows as a regularisation falls.
  std::vector<bool> floppy_nodes();

 private:
  using Pairs = std::vector<std::pair<Index, Index>>;

  Point direction(Index from, Index to) const;
  void add_ranges();
  void hold_frame(const std::vector<Index>& nodes, std::size_t first_pair);
  std::vector<Index> frame_nodes() const;
  Eigen::MatrixXd rigid_motions(const std::vector<Index>& nodes) const;
  void factorise(double regularisation);
  std::vector<Eigen::MatrixXd> diagonal_blocks() const;
  void set_up();
  void subtract_cross_terms(const std::vector<std::size_t>& exact,
                            std::vector<double>& variances) const;
  bool between_unknowns(std::size_t k) const;
  double residual(std::size_t k) const;  // measured less predicted
  double information(std::size_t k) const;
  double noise(std::size_t k) const;  // its variance

  const RangeProblem& problem_;
  const std::vector<bool>& use_;
  const Placement& placement_;
  bool unit_weights_ = false;
  const std::vector<double>* given_ = nullptr;  // information
  std::vector<Index> variable_;                 // node -> its block, -1 if it is no unknown
  std::vector<Index> unknown_nodes_;
  spectral::BlockCholesky matrix_;
};

}  // namespace isotherm::network::detail
