#pragma once

#include <cstddef>

#include "isotherm/spectral/types.hpp"

/// Every constant that the localiser decides by: what it means, its unit, and where it comes from.
/// What each is worth, on networks that none was chosen on, is in docs/results/networks.md.
/// Constants that guard against rounding, bound repetitions or samples, or tell how long a step
/// takes stand where they are used.
namespace isotherm::network::detail {

// The model.

/// Probability from which on something counts as so: likelier than not.
inline constexpr double kLikely = 0.5;

/// Standard deviations that noise hardly ever exceeds (one in 370 times): an excess below is not
/// told from it, and points that stand no farther from a line may lie on it.
inline constexpr double kHardlyNoise = 3.0;

/// Deviation, of the typical distance, of ranges that come without one, until the residuals tell.
inline constexpr double kProvisionalNoise = 0.05;

/// Change of the log of a common deviation that is worth deciding on all ranges anew: it moves the
/// gate by as much as a twentieth of a deviation.
inline constexpr double kSameNoise = 0.05;

/// Ranges beyond those that the estimate uses up from which stated deviations are corrected: the
/// log of a scale is then known to within .22, a factor of 1.25.
inline constexpr double kEnoughRanges = 10.0;

// Absence.

/// Part of the trusted ranges that all but outliers keep within,
inline constexpr double kMostRanges = 0.9;
/// and the end of the curve, in lengths of the longest of these: beyond, hardly any are measured.
inline constexpr double kAbsenceEnd = 1.5;
/// Pieces of the curve: each as wide as a twelfth of the longest of most ranges.
inline constexpr std::size_t kAbsenceBins = 16;

/// Pairs without a range that each piece is given: without pairs to learn from absence says
/// nothing.
inline constexpr double kGranted = 3.0;

/// Least part of the pairs that have no range for reasons of their own, even where all are in
/// reach.
inline constexpr double kLeastAbsent = 0.02;

/// Reaches around the middle of a node's neighbours in which strangers count: as far as a place may
/// be that has ranges to most of them, and one more.
inline constexpr double kStrangersAround = 2.5;

// The search.

/// Twice the nats by which a map must be better to go on: less is "not worth more than a bare
/// mention" (Kass and Raftery, Bayes Factors, 1995, table of section 3.2).
inline constexpr double kBetter = 2.0;

/// Standard deviations of a range from which on two places are two.
inline constexpr double kApart = 4.0;

/// Width, in typical ranges, of the springs' loss at first: a map by shortest paths errs by no more
/// between neighbours.
inline constexpr double kRoughMap = 1.5;

/// Deviation, in reaches, of what keeps nodes without a range apart,
inline constexpr double kRepulsion = 0.05;
/// and the width of its loss, in such deviations: up to a third of a reach it pushes.
inline constexpr double kRepulsionWidth = 6.0;

/// Widths of a loss beyond which a range weighs less than .4 % and is left out.
inline constexpr double kFarOutside = 4.0;

/// Part of the trusted pairs that may contradict a map before the other start is tried.
inline constexpr double kHardlyAny = 0.005;

/// Ranges from the middle of a region that is drawn anew to its outermost nodes, and from what has
/// moved to the lines that parts may now be folded in: about the extent of the largest parts.
inline constexpr int kRegionSteps = 5;

// Parts that fold over.

/// Nodes of the largest part that is looked at: of larger ones the others are seldom fewer.
inline constexpr Index kLargestPart = 200;

/// What breaks a pair, in costs of a range of any length,
inline constexpr double kBroken = 0.5;
/// and the most that a fold may cost before anything gives way, in the same.
inline constexpr double kMostBroken = 10.0;

/// Part of the nodes of either part that are in both where parts are alike.
inline constexpr double kAlike = 0.8;

}  // namespace isotherm::network::detail
