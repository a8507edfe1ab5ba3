#include "isotherm/slam/evaluate/ground_truth.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>
#include <variant>

#include "isotherm/base/error.hpp"
#include "isotherm/base/text_reader.hpp"
#include "isotherm/slam/graph/trajectory.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/slam/io/trajectory_file.hpp"

namespace isotherm::slam {
namespace {

template <class Pose>
struct TimedPose {
  double time = 0.0;  // seconds
  Pose pose;
};

template <class Pose>
using TimedPoses = std::vector<TimedPose<Pose>>;

// Rotation along the shorter arc, translation on the line.
Pose2 interpolate(const Pose2& a, const Pose2& b, double share) {
  return {a.translation() + share * (b.translation() - a.translation()),
          wrap_angle(a.angle() + share * wrap_angle(b.angle() - a.angle()))};
}

Pose3 interpolate(const Pose3& a, const Pose3& b, double share) {
  return {a.translation() + share * (b.translation() - a.translation()),
          a.rotation().slerp(share, b.rotation())};
}

template <class Pose>
std::optional<Pose> pose_at(const TimedPoses<Pose>& samples, double time, double max_gap) {
  const auto after =
      std::lower_bound(samples.begin(), samples.end(), time,
                       [](const TimedPose<Pose>& sample, double t) { return sample.time < t; });
  const auto& next = after == samples.end() ? samples.back() : *after;
  const auto& last = after == samples.begin() ? samples.front() : *(after - 1);
  const double gap = std::min(std::abs(next.time - time), std::abs(last.time - time));
  if (max_gap > 0.0 && gap > max_gap) return std::nullopt;
  if (next.time <= last.time || time >= next.time) return next.pose;
  if (time <= last.time) return last.pose;
  return interpolate(last.pose, next.pose, (time - last.time) / (next.time - last.time));
}

template <class Pose, class Sample>
Pose adapt(const Sample& pose, Axes axes) {
  if constexpr (std::is_same_v<Sample, Pose3>) {
    const Pose3 turned = axes == Axes::camera ? camera_to_vehicle(pose) : pose;
    if constexpr (std::is_same_v<Pose, Pose2>) {
      return flatten(turned);
    } else {
      return turned;
    }
  } else if constexpr (std::is_same_v<Pose, Pose2>) {
    return pose;
  } else {
    return lift(pose);
  }
}

template <class Pose>
std::vector<std::optional<Pose>> from_pose_graph(const PoseGraph<Pose>& graph,
                                                 const PoseGraphFile& file, Axes axes) {
  return std::visit(
      [&](const auto& truth) {
        if (truth.poses.empty()) {
          throw InvalidArgument("ground-truth", file.report.path + " has no vertex poses");
        }
        std::vector<std::optional<Pose>> poses(graph.ids.size());
        for (std::size_t v = 0; v < poses.size(); ++v) {
          const auto position = truth.find(graph.ids[v]);
          if (position) poses[v] = adapt<Pose>(truth.poses[*position], axes);
        }
        return poses;
      },
      file.graph);
}

// Half a truth is more often that of other poses, under the same numbers.
template <class Pose>
void require_most(const std::vector<std::optional<Pose>>& poses, const GroundTruthSource& source) {
  const auto known = count_known(poses);
  if (source.partial || 2 * known >= poses.size()) return;
  throw InvalidArgument("ground-truth",
                        source.path + " has a pose for " + std::to_string(known) + " of " +
                            std::to_string(poses.size()) +
                            " vertices only; are ids, or times, those of the graph? (--partial "
                            "accepts it)");
}

template <class Pose>
std::vector<std::optional<Pose>> match_samples(const PoseGraph<Pose>& graph,
                                               const TimedPoses<Pose>& samples,
                                               const GroundTruthSource& source) {
  const std::size_t n = graph.ids.size();
  std::vector<std::optional<Pose>> poses(n);
  if (source.timestamps.empty()) {
    if (samples.size() != n) {
      throw InvalidArgument("ground-truth",
                            source.path + " has no ids, and " + std::to_string(samples.size()) +
                                " poses for a graph of " + std::to_string(n) +
                                "; --timestamps FILE gives the time of each vertex, by which they "
                                "are matched");
    }
    for (std::size_t v = 0; v < n; ++v) poses[v] = samples[v].pose;
    return poses;
  }
  const auto times = read_timestamps(source.timestamps);
  if (times.size() != n) {
    throw InvalidArgument("timestamps", source.timestamps + " has " + std::to_string(times.size()) +
                                            " times for a graph of " + std::to_string(n));
  }
  for (std::size_t v = 0; v < n; ++v) poses[v] = pose_at(samples, times[v], source.max_gap);
  return poses;
}

// The samples of a trajectory in order of time; without times, in file order.
template <class Pose>
TimedPoses<Pose> timed_poses(const AnyTrajectory& any, Axes axes) {
  return std::visit(
      [axes](const auto& trajectory) {
        TimedPoses<Pose> samples;
        for (std::size_t k = 0; k < trajectory.poses.size(); ++k) {
          const double time = trajectory.timestamps.empty() ? 0.0 : trajectory.timestamps[k];
          samples.push_back({time, adapt<Pose>(trajectory.poses[k], axes)});
        }
        std::stable_sort(samples.begin(), samples.end(),
                         [](const auto& a, const auto& b) { return a.time < b.time; });
        return samples;
      },
      any);
}

bool has_timestamps(const AnyTrajectory& any) {
  return std::visit([](const auto& trajectory) { return !trajectory.timestamps.empty(); }, any);
}

}  // namespace

template <class Pose>
std::vector<std::optional<Pose>> read_ground_truth(const PoseGraph<Pose>& graph,
                                                   const GroundTruthSource& source) {
  if (!(source.max_gap >= 0.0)) throw InvalidArgument("max-gap", "must not be negative");
  TextReader reader(source.path);
  const FileFormat format = detect_format(reader);
  std::vector<std::optional<Pose>> poses;
  if (content_of(format) == FileContent::pose_graph) {
    if (!source.timestamps.empty()) {
      throw InvalidArgument("timestamps", "have no use: " + source.path + " is matched by id");
    }
    poses = from_pose_graph(graph, read_pose_graph(reader, format), source.axes);
  } else {
    const auto file = read_trajectory(reader, format);
    if (!source.timestamps.empty() && !has_timestamps(file.trajectory)) {
      throw InvalidArgument("ground-truth",
                            source.path + " has no times to match with " + source.timestamps);
    }
    const bool camera = source.axes == Axes::automatic && format == FileFormat::kitti &&
                        std::is_same_v<Pose, Pose2>;
    poses = match_samples(
        graph, timed_poses<Pose>(file.trajectory, camera ? Axes::camera : source.axes), source);
  }
  require_most(poses, source);
  return poses;
}

template std::vector<std::optional<Pose2>> read_ground_truth(const PoseGraph<Pose2>&,
                                                             const GroundTruthSource&);
template std::vector<std::optional<Pose3>> read_ground_truth(const PoseGraph<Pose3>&,
                                                             const GroundTruthSource&);

}  // namespace isotherm::slam
