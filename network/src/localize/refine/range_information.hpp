#pragma once

#include <vector>

#include <Eigen/Core>

#include "isotherm/spectral/sparse/inverse_entries.hpp"
#include "localize/problem/range_problem.hpp"
#include "localize/problem/small_network.hpp"

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

  Index unknowns() const { return static_cast<Index>(matrix_.rows()); }

  /// Leave-one-out tests of all ranges. Two selected inversions. @throws NumericalError
  std::vector<RangeCheck> check_ranges() const;

  /// d x d a node, empty where not placed or an anchor. Without anchors those of the
  /// inner constraints: the covariance of the shape, of minimal trace.
  std::vector<Eigen::MatrixXd> covariances() const;

  /// Which unknown nodes can move without changing a range (one a node; false for
  /// those that are no unknowns), by how the inverse grows as a regularisation falls.
  std::vector<bool> floppy_nodes() const;

 private:
  Index row(Index node) const { return first_row_[node]; }
  Point direction(Index from, Index to) const;
  void hold_frame(std::vector<Eigen::Triplet<double, Index>>& entries) const;
  std::vector<Index> frame_nodes() const;
  Eigen::MatrixXd rigid_motions(const std::vector<Index>& nodes) const;
  spectral::SparseMatrix regularised(double relative) const;
  std::vector<Eigen::MatrixXd> diagonal_blocks(const spectral::SparseMatrix& matrix) const;
  std::vector<double> predicted_variances() const;
  void subtract_cross_terms(const spectral::SparseMatrix& matrix,
                            const std::vector<std::size_t>& exact,
                            std::vector<double>& variances) const;
  bool between_placed(std::size_t k) const;
  double residual(std::size_t k) const;  // measured less predicted
  double information(std::size_t k) const;

  const RangeProblem& problem_;
  const std::vector<bool>& use_;
  const Placement& placement_;
  bool unit_weights_;
  std::vector<Index> first_row_;  // node -> first row, -1 if it is no unknown
  std::vector<Index> unknown_nodes_;
  spectral::SparseMatrix matrix_;  // lower triangle
};

}  // namespace isotherm::network::detail
