#include "isotherm/slam/ranges/range_robots.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "isotherm/base/error.hpp"

namespace isotherm::slam {
namespace {

using network::NodeStatus;

std::string robot_of(const std::string& name) {
  const auto digit = std::ranges::find_if(
      name, [](char c) { return std::isalpha(static_cast<unsigned char>(c)) == 0; });
  return {name.begin(), digit};
}

// Poses by time.
template <class Pose>
std::vector<std::pair<double, Index>> poses_by_time(const RangeGraph<Pose>& graph) {
  std::vector<std::pair<double, Index>> poses;
  std::set<std::string> robots;
  for (Index v = 0; v < graph.node_count(); ++v) {
    if (graph.is_point[v]) continue;
    if (!std::isfinite(graph.stamps[v])) {
      throw InvalidArgument("odometry", "has poses without time stamps");
    }
    robots.insert(robot_of(graph.names[v]));
    poses.emplace_back(graph.stamps[v], v);
  }
  if (poses.empty()) throw InvalidArgument("odometry", "has no poses");
  if (robots.size() > 1) throw InvalidArgument("odometry", "is that of several robots");
  std::ranges::sort(poses);
  return poses;
}

// A beacon of the log, in the graph.
template <class Pose>
class Beacons {
 public:
  Beacons(const network::RangeNetwork& log, RangeGraph<Pose>& graph) : log_(log), graph_(graph) {
    for (Index v = 0; v < graph.node_count(); ++v) node_of_[graph.names[v]] = v;
  }

  Index node(Index beacon) {
    const auto [entry, added] = node_of_.try_emplace(log_.names[beacon], graph_.node_count());
    if (added) add(beacon);
    return entry->second;
  }

 private:
  void add(Index beacon) {
    Pose position;
    const bool known = beacon < log_.positions.cols() && log_.dimension == Pose::kDim &&
                       log_.positions.col(beacon).allFinite();
    if (known) {
      typename Pose::Tangent tangent = Pose::Tangent::Zero();
      tangent.template head<Pose::kDim>() = log_.positions.col(beacon);
      position = Pose::exp(tangent);
    }
    graph_.names.push_back(log_.names[beacon]);
    graph_.positions.push_back(position);
    graph_.placed.push_back(known);
    graph_.is_point.push_back(true);
    graph_.stamps.push_back(std::numeric_limits<double>::quiet_NaN());
  }

  const network::RangeNetwork& log_;
  RangeGraph<Pose>& graph_;
  std::map<std::string, Index> node_of_;
};

}  // namespace

template <class Pose>
AttachedRanges attach_ranges(const network::RangeNetwork& log, RangeGraph<Pose>& graph) {
  const auto poses = poses_by_time(graph);
  // Beyond the ends by more than the longest step, nothing says where the robot was.
  double longest = 0.0;
  for (std::size_t k = 1; k < poses.size(); ++k) {
    longest = std::max(longest, poses[k].first - poses[k - 1].first);
  }
  std::vector<bool> is_beacon(log.names.size(), false);
  for (const Index v : log.landmarks) is_beacon[v] = true;
  Beacons<Pose> beacons(log, graph);
  graph.ranges.clear();
  AttachedRanges attached;
  for (auto range : log.ranges) {
    if (is_beacon[range.from]) std::swap(range.from, range.to);
    if (is_beacon[range.from] || !is_beacon[range.to]) {
      throw InvalidArgument("ranges", "must be those of a log of one robot among beacons");
    }
    auto after = std::ranges::lower_bound(poses, std::pair<double, Index>(range.timestamp, -1));
    if (after == poses.end()) --after;
    auto nearest = after;
    if (after != poses.begin()) {
      const auto before = std::prev(after);
      if (range.timestamp - before->first < std::abs(after->first - range.timestamp)) {
        nearest = before;
      }
    }
    if (std::abs(nearest->first - range.timestamp) > longest) {
      ++attached.outside;
      continue;
    }
    range.from = nearest->second;
    range.to = beacons.node(range.to);
    graph.ranges.push_back(range);
    ++attached.attached;
  }
  return attached;
}

template <class Pose>
network::RangeNetwork network_of(const RangeGraph<Pose>& graph) {
  network::RangeNetwork network;
  network.dimension = Pose::kDim;
  network.names = graph.names;
  network.ranges = graph.ranges;
  network.positions.resize(Pose::kDim, graph.node_count());
  for (Index v = 0; v < graph.node_count(); ++v) {
    network.positions.col(v) = graph.positions[v].translation();
    if (!graph.placed[v]) {
      network.positions.col(v).setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    if (graph.is_point[v]) network.landmarks.push_back(v);
  }
  return network;
}

template <class Pose>
network::LocalizeResult as_localize_result(const RangeGraph<Pose>& graph,
                                           const LocateResult<Pose>& result) {
  network::LocalizeResult same;
  same.positions.resize(Pose::kDim, graph.node_count());
  for (Index v = 0; v < graph.node_count(); ++v) {
    same.positions.col(v) = result.poses[v].translation();
    const auto status = result.nodes[v];
    const bool placed = status == NodeStatus::anchor || status == NodeStatus::localised ||
                        status == NodeStatus::mirrored;
    if (!placed) same.positions.col(v).setConstant(std::numeric_limits<double>::quiet_NaN());
    // What is held has no uncertainty of its own: the frame is fixed there.
    same.covariances.push_back(placed && result.covariances[v].size() == 0
                                   ? Eigen::MatrixXd::Zero(Pose::kDim, Pose::kDim)
                                   : result.covariances[v]);
  }
  same.nodes = result.nodes;
  same.verdicts = result.verdicts;
  same.status = result.status;
  same.anchored = result.anchored;
  same.noise_factor = result.errors.scale;
  same.iterations = result.iterations;
  same.seconds = result.seconds;
  return same;
}

template <class Pose>
std::vector<RobotTrajectory<Pose>> robot_trajectories(const RangeGraph<Pose>& graph,
                                                      const LocateResult<Pose>& result) {
  std::vector<RobotTrajectory<Pose>> robots;
  std::map<std::string, std::size_t> place;
  std::vector<Index> order(static_cast<std::size_t>(graph.node_count()));
  std::iota(order.begin(), order.end(), 0);
  const bool stamped = std::ranges::all_of(
      order, [&](Index v) { return graph.is_point[v] || std::isfinite(graph.stamps[v]); });
  for (const Index v : order) {
    if (!graph.is_point[v]) {
      const auto robot = robot_of(graph.names[v]);
      if (place.try_emplace(robot, robots.size()).second) robots.push_back({robot, {}});
    }
  }
  if (stamped) {
    std::ranges::stable_sort(order, [&](Index a, Index b) {
      if (graph.is_point[a] || graph.is_point[b]) return graph.is_point[a] < graph.is_point[b];
      return graph.stamps[a] < graph.stamps[b];
    });
  }
  for (const Index v : order) {
    const auto status = result.nodes[v];
    if (graph.is_point[v] || (status != NodeStatus::localised && status != NodeStatus::mirrored)) {
      continue;
    }
    auto& trajectory = robots[place.at(robot_of(graph.names[v]))].trajectory;
    trajectory.poses.push_back(result.poses[v]);
    if (stamped) trajectory.timestamps.push_back(graph.stamps[v]);
  }
  return robots;
}

template AttachedRanges attach_ranges(const network::RangeNetwork&, RangeGraph<Pose2>&);
template AttachedRanges attach_ranges(const network::RangeNetwork&, RangeGraph<Pose3>&);
template network::RangeNetwork network_of(const RangeGraph<Pose2>&);
template network::RangeNetwork network_of(const RangeGraph<Pose3>&);
template network::LocalizeResult as_localize_result(const RangeGraph<Pose2>&,
                                                    const LocateResult<Pose2>&);
template network::LocalizeResult as_localize_result(const RangeGraph<Pose3>&,
                                                    const LocateResult<Pose3>&);
template std::vector<RobotTrajectory<Pose2>> robot_trajectories(const RangeGraph<Pose2>&,
                                                                const LocateResult<Pose2>&);
template std::vector<RobotTrajectory<Pose3>> robot_trajectories(const RangeGraph<Pose3>&,
                                                                const LocateResult<Pose3>&);

}  // namespace isotherm::slam
