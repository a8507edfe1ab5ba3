#include "verbs/evaluate/trajectory_input.hpp"

#include <algorithm>
#include <type_traits>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/slam/io/trajectory_file.hpp"
#include "verbs/input/truth_input.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;

bool is_pose_graph(const std::string& path) {
  TextReader reader(path);
  return content_of(detect_format(reader)) == FileContent::pose_graph;
}

bool is_planar(const AnyTrajectory& any) { return std::holds_alternative<Trajectory<Pose2>>(any); }

Trajectory<Pose3> in_space(const AnyTrajectory& any) {
  if (const auto* planar = std::get_if<Trajectory<Pose2>>(&any)) return lift(*planar);
  return std::get<Trajectory<Pose3>>(any);
}

bool has_times(const AnyTrajectory& any) {
  return std::visit([](const auto& trajectory) { return !trajectory.timestamps.empty(); }, any);
}

// Poses that have no times get those of the file.
void give_times(AnyTrajectory& any, const std::string& path, const std::string& timestamps) {
  if (has_times(any)) throw InvalidArgument("--timestamps", path + " has times of its own");
  auto times = read_timestamps(timestamps);
  std::visit(
      [&](auto& trajectory) {
        if (times.size() != trajectory.poses.size()) {
          throw InvalidArgument("--timestamps",
                                fmt::format("{} has {} times for the {} poses of {}", timestamps,
                                            times.size(), trajectory.poses.size(), path));
        }
        trajectory.timestamps = std::move(times);
      },
      any);
}

void require_times(const AnyTrajectory& estimate, const std::string& estimate_path,
                   const AnyTrajectory& truth, const std::string& truth_path) {
  if (has_times(estimate) == has_times(truth)) return;
  if (has_times(truth)) {
    throw InvalidArgument("--timestamps",
                          fmt::format("FILE is needed: {} has times by which poses are matched, {} "
                                      "has none; FILE gives them, in seconds, one a line",
                                      truth_path, estimate_path));
  }
  throw InvalidArgument("ground-truth",
                        fmt::format("{} has no times, {} has: give a truth with times, or poses "
                                    "without (KITTI's format) of the same number",
                                    truth_path, estimate_path));
}

void report_match(std::size_t matched, std::size_t poses, const char* what, bool partial,
                  const CommonFlags& flags) {
  say(flags, fmt::format("{} of {} {} have a true one at the same time", matched, poses, what));
  if (partial || 2 * matched >= poses) return;
  throw InvalidArgument("ground-truth",
                        fmt::format("only {} of {} {} match; are times of one clock, in seconds? "
                                    "See --max-gap; --partial accepts it",
                                    matched, poses, what));
}

}  // namespace

void TrajectoryInput::add_to(CLI::App& verb) {
  verb.add_option("estimate", estimate_, "pose graph or trajectory to judge")->required();
  verb.add_option("ground-truth", truth_.path, "pose graph or trajectory taken as true")
      ->required();
  verb.add_option("--timestamps", truth_.timestamps,
                  "time of each estimated pose in seconds, one a line, by which a graph or a "
                  "trajectory without times is matched with a truth that has times")
      ->type_name("FILE");
  add_number(verb, "--max-gap", truth_.max_gap,
             "seconds to the nearest true pose beyond which there is none; 0: any for a graph "
             "with --timestamps, else 0.01",
             closed(0, 1e9))
      ->default_str("0");
  add_truth_flags(verb, truth_);
}

AnyPosePairs TrajectoryInput::read(const CommonFlags& flags) const {
  if (!is_pose_graph(estimate_)) return pairs_by_time(flags);
  const auto file = read_pose_graph(estimate_, {.strict = flags.strict});
  return std::visit(
      [&](const auto& graph) -> AnyPosePairs {
        const auto true_poses = read_ground_truth(graph, truth_);
        say(flags, fmt::format("ground truth: {} of {} poses have one", count_known(true_poses),
                               true_poses.size()));
        auto pairs = pair_poses(trajectory_of(graph).poses, true_poses);
        warn_of_motion(pairs, "the estimate", flags);
        return pairs;
      },
      file.graph);
}

AnyPosePairs TrajectoryInput::pairs_by_time(const CommonFlags& flags) const {
  auto estimate = read_trajectory(estimate_, {.strict = flags.strict}).trajectory;
  auto read = read_trajectory(truth_.path, {.strict = flags.strict});
  auto& truth = read.trajectory;
  if (!truth_.timestamps.empty()) give_times(estimate, estimate_, truth_.timestamps);
  require_times(estimate, estimate_, truth, truth_.path);
  const bool camera =
      truth_.axes == Axes::camera || (truth_.axes == Axes::automatic && is_planar(estimate) &&
                                      read.report.format == enum_name(FileFormat::kitti));
  if (auto* spatial = std::get_if<Trajectory<Pose3>>(&truth); spatial != nullptr && camera) {
    for (auto& pose : spatial->poses) pose = camera_to_vehicle(pose);
  }
  const double max_gap = truth_.max_gap > 0.0 ? truth_.max_gap : 0.01;
  const auto paired = [&](const auto& a, const auto& b) -> AnyPosePairs {
    auto pairs = pair_trajectories(a, b, max_gap);
    const bool shorter = a.poses.size() <= b.poses.size();
    report_match(pairs.estimate.size(), std::min(a.poses.size(), b.poses.size()),
                 shorter ? "estimated poses" : "true poses", truth_.partial, flags);
    warn_of_motion(pairs, "the estimate", flags);
    return pairs;
  };
  if (is_planar(estimate) && is_planar(truth)) {
    return paired(std::get<Trajectory<Pose2>>(estimate), std::get<Trajectory<Pose2>>(truth));
  }
  return paired(in_space(estimate), in_space(truth));
}

}  // namespace isotherm::apps
