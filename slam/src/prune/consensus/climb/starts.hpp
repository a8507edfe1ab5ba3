#pragma once

#include <array>

#include "prune/consensus/estimate/estimate.hpp"

namespace isotherm::slam::detail {

/// Factors on the stated covariances of odometry and of loops to start from. What is true agrees
/// best: a climb that starts from sharper loops than stated is not drawn to false ones first.
inline constexpr std::array<CovarianceScale, 4> kStarts = {
    {{1.0, 1.0}, {100.0, 1.0}, {1.0, 0.01}, {0.01, 0.01}}};

}  // namespace isotherm::slam::detail
