#pragma once

#include <array>
#include <cstddef>
#include <numbers>

#include "prune/consensus/covariance_scale.hpp"

/// Every constant that consensus decides by: what it means, its unit, and where it comes from. What
/// each is worth, on graphs that none was chosen on, is in docs/results/ablation.md. Constants that
/// guard against rounding, bound repetitions or samples, or tell how long a step takes stand where
/// they are used.
namespace isotherm::slam::detail {

// The model.

/// Deviation of the log of a factor on covariances, of all coordinates and of each: that of a
/// factor of ten in the error.
inline constexpr double kScaleDeviation = 2.0 * std::numbers::ln10;

/// Deviation of the mean error of odometry's turns before anything is measured, in those of one
/// step: by ground truth KITTI's five robots have .05 to .1.
inline constexpr double kBiasDeviation = 0.1;

/// Of variances, from one kind of loop to the next: a scale between two is off by a factor of 1.3
/// in the error at most, of which a loop tells nothing.
inline constexpr double kScaleStep = 3.0;

/// Loops as accurate as most that count as seen before any is, and as many less accurate: of the
/// share of either nothing is known (a uniform distribution).
inline constexpr double kLoopsBefore = 1.0;

/// Share of the false loops after a false one that follow it: of real detectors' a quarter to three
/// quarters do (Bicocca, Bovisa). Less, so that each must be twenty times likelier as one of a
/// false run than as a true one: true loops of a clean file agree with each other as well.
inline constexpr double kFalseFollowing = 0.05;

/// False loops that join their poses by chance, counted as seen before any is, against one that
/// joins the right place and measures it wrong: few of a clean file's must be taken for that.
inline constexpr double kFalseByChance = 100.0;

/// Degrees of freedom of Student's t of what loops measure: heavy tails, of finite variance (Lange,
/// Little and Taylor, Robust Statistical Modeling Using the t Distribution, 1989, section 5).
inline constexpr double kTailDof = 4.0;

/// Deviations to which the kernel of near pairs reaches: beyond, it is below .003 of its peak.
inline constexpr double kReach = 3.5;

/// Fewer true loops say too little of how accurate odometry is for another to be pruned.
inline constexpr std::size_t kFewLoops = 5;

// The search.

/// Factors on the stated covariances of odometry and of loops to start from: whether climbs take
/// them for known until no more loop agrees with them, and whether they do not. Loops agree with
/// odometry, at one of these scales, or with each other, those best that are true: from sharper
/// loops than stated a climb is not drawn to false ones first. The first four always, the others
/// until one leads anywhere: of errors that are all stated a hundred times too small no loop agrees
/// with the next.
struct StartScales : CovarianceScale {
  bool known;
  bool unknown;
};
inline constexpr std::array<StartScales, 9> kStarts = {{{{1.0, 1.0}, true, false},
                                                        {{100.0, 1.0}, true, true},
                                                        {{1.0, 0.01}, false, true},
                                                        {{0.01, 0.01}, true, false},
                                                        {{100.0, 100.0}, false, true},
                                                        {{1.0, 100.0}, false, true},
                                                        {{0.01, 1.0}, false, true},
                                                        {{100.0, 0.01}, false, true},
                                                        {{0.01, 100.0}, false, true}}};
inline constexpr std::size_t kStartsAlways = 4;

/// Loops in a sample at least: half of them false, the rest tell the log of a scale to within .1.
/// Of fewer all are looked at at once.
inline constexpr std::size_t kLeastSample = 200;

/// Nats by which an explanation must be better to go on: less is "not worth more than a bare
/// mention" (Kass and Raftery, Bayes Factors, 1995, table of section 3.2).
inline constexpr double kBetter = 1.0;

/// Times as many loops as at the last lesson have more to tell of how accurate they are.
inline constexpr std::size_t kMoreTelling = 2;

/// Groups accepted at once are all true with even odds at least.
inline constexpr double kMostExpectedFalse = 0.5;

/// Times as many loops as before that are accepted at once: each sharpens what is predicted of the
/// rest and tells how accurate they are.
inline constexpr std::size_t kBatchGrowth = 10;

// Accuracy.

/// Steps below this many standard deviations of the links they move do not matter.
inline constexpr double kSettled = 0.01;

/// Changes of a loop's weight that do not matter: of logs, root mean square.
inline constexpr double kSameWeight = 0.05;

}  // namespace isotherm::slam::detail
