#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include "isotherm/base/options.hpp"
#include "isotherm/base/range.hpp"
#include "isotherm/slam/graph/trajectory.hpp"

namespace isotherm::slam {

/// Which rigid motion is applied to the estimate before it is compared.
enum class Alignment {
  first,  ///< the one that makes the first poses equal, heading included
  se,     ///< the one with the least squared distance of positions, without scale:
          ///< S. Umeyama, "Least-squares estimation of transformation parameters
          ///< between two point patterns", PAMI 1991
  none,
};

constexpr std::array<EnumName<Alignment>, 3> enum_names(Alignment) {
  return {{{Alignment::first, "first"}, {Alignment::se, "se"}, {Alignment::none, "none"}}};
}

/// Estimated poses and the true pose of each, in order of time.
template <class Pose>
struct PosePairs {
  std::vector<Pose> estimate;
  std::vector<Pose> truth;
};

/// Poses by position; those without truth are left out.
/// @throws InvalidArgument if the two differ in size.
template <class Pose>
PosePairs<Pose> pair_poses(const std::vector<Pose>& estimate,
                           const std::vector<std::optional<Pose>>& truth);

/// Poses of two trajectories at the same time: each pose of the shorter one with
/// the nearest in time of the other, unless that is more than `max_difference`
/// seconds away (the rule of evo). Without time stamps in either, by position.
/// @throws InvalidArgument if stamps are there for one only, go back, or, without
///   stamps, the two differ in length.
template <class Pose>
PosePairs<Pose> pair_trajectories(const Trajectory<Pose>& estimate, const Trajectory<Pose>& truth,
                                  double max_difference = 0.01);

/// Summary of a list of errors. All zero for an empty one.
struct ErrorStatistics {
  std::int64_t pairs = 0;  ///< how many errors
  double mean = 0.0;
  double rmse = 0.0;
  double median = 0.0;
  double max = 0.0;
  double min = 0.0;
  double std = 0.0;  ///< standard deviation, divided by the number of pairs
};

ErrorStatistics summarize(std::vector<double> errors);

/// The motion T for which T * estimate is compared with the truth.
/// @throws InvalidArgument for no pairs, or, for `se`, positions that leave the
///   rotation open (all in one point; in space, all on one line).
template <class Pose>
Pose align(const PosePairs<Pose>& pairs, Alignment alignment);

/// Absolute trajectory error: distance in metres between each aligned estimated
/// position and its true one. Two common readings of it: `se` with `rmse` (J. Sturm
/// et al., "A Benchmark for the Evaluation of RGB-D SLAM Systems", IROS 2012, and
/// evo), and `first` with `mean` (the heat-kernel paper's ATE, after Rawseeds).
template <class Pose>
ErrorStatistics absolute_trajectory_error(const PosePairs<Pose>& pairs, Alignment alignment);

struct RelativeErrorOptions {
  int delta = 1;           ///< poses between the two ends of a pair, >= 1
  bool all_pairs = false;  ///< (0,d), (1,d+1), ... instead of (0,d), (d,2d), ...

  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, RelativeErrorOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("delta", options.delta, "poses between the two ends of a pair (rpe)", closed(1, 1e9));
  visit("all_pairs", options.all_pairs, "overlapping pairs instead of consecutive ones (rpe)");
}

struct RelativeError {
  ErrorStatistics translation;  ///< metres
  ErrorStatistics rotation;     ///< radians
};

/// Relative pose error: how far each estimated motion over `delta` poses is from
/// the true one, |Q^-1 P| with Q the true and P the estimated relative pose (Sturm
/// et al., eq. 2). Needs no alignment.
template <class Pose>
RelativeError relative_pose_error(const PosePairs<Pose>& pairs,
                                  const RelativeErrorOptions& options = {});

/// How differently the two move: of stretches over ten poses, the median distance between the
/// estimated and the true motion as a share of the longer of the two; from 0 to 2, a few per
/// cent where both are of one body with one kind of axes. 0 if nothing moves.
template <class Pose>
double motion_disagreement(const PosePairs<Pose>& pairs);

}  // namespace isotherm::slam
