#pragma once

#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "isotherm/spectral/sparse/block_cholesky.hpp"

namespace isotherm::spectral {

/// The blocks of Z = A^-1 that belong to a pair of block rows.
template <int Dof>
struct PairCovariance {
  using Block = Eigen::Matrix<double, Dof, Dof>;
  Block first = Block::Zero();   ///< Z_aa
  Block second = Block::Zero();  ///< Z_bb
  Block cross = Block::Zero();   ///< Z_ab
};

/// One answer a pair, from the supernodal factor that `factor` holds. A negative row
/// stands for one that A does not have; its blocks are zero.
///
/// Takahashi's recurrence from the root of the elimination tree down (Takahashi, Fagan
/// and Chin 1973; Erisman and Tinney 1975), with dense fronts: each holds all of Z
/// between the rows of one supernode. A pair in the pattern of the factor is read
/// there. For any other pair, what stands below the front where the branches of its two
/// rows meet is eliminated from e_a and e_b; with w_a and w_b what remains of them on
/// that front's rows, Z_ab = w_a' Z w_b. Where so many pairs meet that it takes less time,
/// the rows of L^-1 for that front and those above are solved for all of them at once
/// instead, whose products are Z_ab. Only branches that lead to a pair are visited.
/// All pairs of neighbours together cost about two factorisations; a pair whose
/// branches meet near the root costs a triangular solve along them.
/// Those rows are solved for on `threads` threads (0: all cores). `Dof`, of 2, 3 and 6, is the
/// factor's block size.
/// @throws InvalidArgument if the factor is not supernodal
template <int Dof>
std::vector<PairCovariance<Dof>> pair_covariances(const BlockCholesky& factor,
                                                  std::span<const std::pair<Index, Index>> pairs,
                                                  int threads = 1);

}  // namespace isotherm::spectral
