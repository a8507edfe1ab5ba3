#pragma once

#include "isotherm/network/localize/range_mixture.hpp"

namespace isotherm::slam::detail {

/// How ranges of robots come about: measured = offset + stretch * distance + error.
struct RangeModel : network::RangeMixture {
  double offset = 0.0;       ///< metres, as of a clock or an antenna's delay
  double log_stretch = 0.0;  ///< log of the unit ranges are measured in by metres
  double odometry = 1.0;     ///< on the stated covariances of steps
};

}  // namespace isotherm::slam::detail
