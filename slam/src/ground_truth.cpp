#include "isotherm/slam/ground_truth.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "isotherm/base/csv.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/text_reader.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"

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

std::vector<double> read_timestamps(const std::string& path) {
  TextReader reader(path);
  std::vector<double> times;
  while (reader.next_line()) {
    if (reader.at_line_end()) continue;
    times.push_back(reader.number("a time in seconds"));
  }
  return times;
}

TimedPoses<Pose2> read_timed_csv(const std::string& path) {
  CsvReader csv(path);
  TimedPoses<Pose2> samples;
  if (!csv.next_row()) throw ParseError({path, 0, 0}, "", "holds no ground truth");
  const auto time = csv.column("time", 0);
  const auto x = csv.column("x", 1);
  const auto y = csv.column("y", 2);
  const auto theta = csv.column("theta", 3);
  do {
    samples.push_back({csv.number(time, "time in seconds"),
                       {csv.number(x, "x in metres"), csv.number(y, "y in metres"),
                        csv.number(theta, "theta in radians")}});
    if (samples.size() > 1 && samples.back().time < samples[samples.size() - 2].time) {
      csv.fail(time, "expected times that do not go back");
    }
  } while (csv.next_row());
  return samples;
}

template <class Pose>
std::vector<std::optional<Pose>> from_pose_graph(const PoseGraph<Pose>& graph,
                                                 const std::string& path) {
  const auto file = read_pose_graph(path);
  const auto* truth = std::get_if<PoseGraph<Pose>>(&file.graph);
  if (truth == nullptr) {
    throw InvalidArgument("ground-truth", path + " has poses of another dimension than the graph");
  }
  if (truth->poses.empty()) throw InvalidArgument("ground-truth", path + " has no vertex poses");
  std::vector<std::optional<Pose>> poses(graph.ids.size());
  for (std::size_t v = 0; v < poses.size(); ++v) {
    if (const auto position = truth->find(graph.ids[v])) poses[v] = truth->poses[*position];
  }
  return poses;
}

template <class Pose>
std::vector<std::optional<Pose>> match_samples(const PoseGraph<Pose>& graph,
                                               const TimedPoses<Pose>& samples,
                                               const GroundTruthSource& source) {
  const std::size_t n = graph.ids.size();
  std::vector<std::optional<Pose>> poses(n);
  if (source.timestamps.empty()) {
    if (samples.size() != n) {
      throw InvalidArgument("timestamps", "needed: " + source.path + " has " +
                                              std::to_string(samples.size()) +
                                              " poses for a graph of " + std::to_string(n));
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

// Records of a pose graph start with a tag, trajectories with a number or '#'.
bool starts_with_tag(const std::string& path) {
  TextReader reader(path);
  while (reader.next_line()) {
    const auto word = reader.word();
    if (word.empty() || word.front() == '#') continue;
    return std::isupper(static_cast<unsigned char>(word.front())) != 0;
  }
  throw ParseError({path, 0, 0}, "", "is empty");
}

TimedPoses<Pose2> read_samples(const PoseGraph<Pose2>&, const std::string& path) {
  return read_timed_csv(path);
}

TimedPoses<Pose3> read_samples(const PoseGraph<Pose3>&, const std::string& path) {
  throw InvalidArgument("ground-truth", path + " holds poses of the plane; the graph is in space");
}

}  // namespace

template <class Pose>
std::vector<std::optional<Pose>> read_ground_truth(const PoseGraph<Pose>& graph,
                                                   const GroundTruthSource& source) {
  if (!(source.max_gap >= 0.0)) throw InvalidArgument("max-gap", "must not be negative");
  if (starts_with_tag(source.path)) return from_pose_graph(graph, source.path);
  return match_samples(graph, read_samples(graph, source.path), source);
}

template std::vector<std::optional<Pose2>> read_ground_truth(const PoseGraph<Pose2>&,
                                                             const GroundTruthSource&);
template std::vector<std::optional<Pose3>> read_ground_truth(const PoseGraph<Pose3>&,
                                                             const GroundTruthSource&);

}  // namespace isotherm::slam
