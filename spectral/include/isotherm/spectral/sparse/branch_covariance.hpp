#pragma once

#include <memory>
#include <span>

#include <Eigen/Core>

#include "isotherm/spectral/sparse/block_cholesky.hpp"

namespace isotherm::spectral {

namespace detail {
class FrontTree;
}  // namespace detail

/// Covariances of single functions of a few block rows, from a factor that is kept.
///
/// With A = L L' the covariance A^-1 of G' x is |L^-1 G|^2, and only the branches of the
/// elimination tree that lead from the rows of G to the root are visited: that costs as many
/// multiplications a column as L has entries on them. For many pairs at once
/// pair_covariances() takes less time.
template <int Dof>
class BranchCovariance {
 public:
  using Block = Eigen::Matrix<double, Dof, Dof>;

  /// A block row and its part of G; a negative row is one that A does not have.
  struct Term {
    Index row;
    Block G;
  };

  /// `factor` must outlive this object, and not be factorised meanwhile.
  /// @throws InvalidArgument if the factor is not supernodal
  explicit BranchCovariance(const BlockCholesky& factor);
  ~BranchCovariance();
  BranchCovariance(BranchCovariance&&) noexcept;
  BranchCovariance& operator=(BranchCovariance&&) noexcept;

  /// The sum over all terms a and b of G_a' (A^-1)_ab G_b.
  Block of(std::span<const Term> terms) const;

 private:
  std::unique_ptr<const detail::FrontTree> tree_;
};

extern template class BranchCovariance<2>;
extern template class BranchCovariance<3>;
extern template class BranchCovariance<6>;

}  // namespace isotherm::spectral
