#include "verbs/input/truth_input.hpp"

#include <type_traits>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/slam/graph/odometry.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;

// Poses of one body differ by the drift over ten poses: a few per cent.
constexpr double kDifferent = 0.25;

template <class Pose>
bool is_that_of_a_camera(PosePairs<Pose> pairs, double as_it_is) {
  if constexpr (std::is_same_v<Pose, Pose3>) {
    for (auto& pose : pairs.truth) pose = camera_to_vehicle(pose);
    return motion_disagreement(pairs) < as_it_is / 3.0;
  } else {
    return false;
  }
}

}  // namespace

void add_truth_flags(CLI::App& verb, GroundTruthSource& truth) {
  verb.add_option_function<std::string>(
          "--axes",
          [&truth](const std::string& name) { truth.axes = enum_value<Axes>("--axes", name); },
          "axes of true poses in space: vehicle (x forward, z up) or camera (z forward, y down); "
          "automatic: camera where a map in the plane meets KITTI's format")
      ->type_name(joined_enum_names<Axes>())
      ->default_str("automatic");
  verb.add_flag("--partial", truth.partial, "accept a truth of fewer than half of the poses");
}

template <class Pose>
std::vector<std::optional<Pose>> read_truth(const PoseGraph<Pose>& graph,
                                            const GroundTruthSource& source,
                                            const CommonFlags& flags) {
  auto truth = read_ground_truth(graph, source);
  say(flags,
      fmt::format("ground truth: {} of {} poses have one", count_known(truth), truth.size()));
  warn_of_motion(pair_poses(odometry_poses(graph, edge_roles(graph)), truth), "odometry", flags);
  return truth;
}

template <class Pose>
void warn_of_motion(const PosePairs<Pose>& pairs, const std::string& other,
                    const CommonFlags& flags) {
  const double share = motion_disagreement(pairs);
  if (share <= kDifferent) return;
  warn(flags, fmt::format("the true poses do not move as {} does: over ten poses they differ by "
                          "{:.0f} % of the way (median); {}",
                          other, 100.0 * share,
                          is_that_of_a_camera(pairs, share)
                              ? "they do with --axes camera"
                              : "are their ids or times the same, and x forward (see --axes)?"));
}

template std::vector<std::optional<Pose2>> read_truth(const PoseGraph<Pose2>&,
                                                      const GroundTruthSource&, const CommonFlags&);
template std::vector<std::optional<Pose3>> read_truth(const PoseGraph<Pose3>&,
                                                      const GroundTruthSource&, const CommonFlags&);
template void warn_of_motion(const PosePairs<Pose2>&, const std::string&, const CommonFlags&);
template void warn_of_motion(const PosePairs<Pose3>&, const std::string&, const CommonFlags&);

}  // namespace isotherm::apps
