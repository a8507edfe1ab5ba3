#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "isotherm/base/random.hpp"

namespace isotherm::slam::detail {

/// A cell of the integer lattice and the frame of a robot that is about to leave
/// it along its first axis.
struct LatticeStop {
  Eigen::Vector3i cell;
  Eigen::Matrix3i frame;
};

/// Where a lattice walk may go.
struct LatticeStreets {
  std::int64_t block = 1;    ///< steps between crossings, >= 1
  std::int64_t limit = 1;    ///< largest absolute coordinate; a multiple of block
  bool up_and_down = false;  ///< whether turns up and down are made too
};

/// A walk of `stops` stops along the streets. At a crossing it goes straight on
/// with probability one half, or turns; never back, never out of the limit.
std::vector<LatticeStop> lattice_walk(std::int64_t stops, const LatticeStreets& streets,
                                      Random& random);

}  // namespace isotherm::slam::detail
