#pragma once

#include <span>
#include <utility>

#include "isotherm/spectral/sparse/block_cholesky.hpp"

namespace isotherm::spectral {

/// Floating-point operations that pair_covariances() takes, from the pattern alone.
struct CovarianceWork {
  double fronts = 0.0;  ///< to invert the dense fronts, which pairs in the pattern are read from
  double pairs = 0.0;   ///< at most, for pairs outside the pattern
};

/// @throws InvalidArgument if the factor is not supernodal
CovarianceWork covariance_work(const BlockCholesky& factor,
                               std::span<const std::pair<Index, Index>> pairs);

}  // namespace isotherm::spectral
