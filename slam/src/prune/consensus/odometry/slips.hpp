#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "isotherm/slam/graph/pose_graph.hpp"
#include "prune/consensus/constants.hpp"

namespace isotherm::slam::detail {

/// How much more edges of odometry err than others, one of each vertex to the next: in deviations
/// of what is believed of a factor on variances (kScaleDeviation), 0 as the others. None where
/// empty. A wheel slips, a matcher fails, and a turn may be told worse than a straight.
using Slips = std::vector<std::uint8_t>;

inline constexpr std::size_t kSlipSizes = 5;  ///< with none; the largest is kMostScale

inline std::uint8_t slip_of(const Slips& slips, Index vertex) {
  return slips.empty() ? std::uint8_t{0} : slips[static_cast<std::size_t>(vertex)];
}

inline bool any_slips(std::span<const std::uint8_t> slips) {
  return std::ranges::any_of(slips, [](std::uint8_t slip) { return slip > 0; });
}

/// On its variances.
inline double slip_factor(std::size_t slip) {
  return std::exp(static_cast<double>(slip) * kScaleDeviation);
}

/// log of how likely it is that just these edges slip so, against that none does: of the share that
/// does nothing is known before (Beta-binomial), and how much is as likely as of a factor on all.
double log_prior_of(const Slips& slips);

/// Of the next of so many edges, of each size against none.
std::array<double, kSlipSizes> log_slip_odds(const Slips& slips, std::size_t edges);

}  // namespace isotherm::slam::detail
