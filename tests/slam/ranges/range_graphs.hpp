#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "isotherm/base/random.hpp"
#include "isotherm/slam/graph/range_graph.hpp"

/// Simulated robots that move among beacons. `positions` hold the truth.
namespace isotherm_test {

using isotherm::Random;
using isotherm::slam::Index;
using isotherm::slam::Pose2;
using isotherm::slam::Pose3;
using isotherm::slam::RangeGraph;

struct RangeWorld {
  int robots = 1;
  int poses = 120;  ///< a robot
  int beacons = 4;
  int ranges = 200;
  double odometry = 0.01;  ///< deviation of a step: metres and radians
  double noise = 0.05;     ///< of a range, metres
  std::uint64_t seed = 1;
};

template <class Pose>
Index add_node(RangeGraph<Pose>& graph, const std::string& name, const Pose& pose, bool is_point,
               double stamp) {
  graph.names.push_back(name);
  graph.positions.push_back(pose);
  graph.placed.push_back(true);
  graph.is_point.push_back(is_point);
  graph.stamps.push_back(stamp);
  return graph.node_count() - 1;
}

template <class Pose>
typename Pose::Tangent noise_of(Random& random, double sigma) {
  typename Pose::Tangent xi;
  for (auto& value : xi) value = random.normal(0.0, sigma);
  return xi;
}

/// Forward one unit a step, turning, and in space rolling and climbing.
template <class Pose>
typename Pose::Tangent motion(int robot, int k) {
  typename Pose::Tangent xi = Pose::Tangent::Zero();
  xi[0] = 1.0;
  xi[Pose::kDof - 1] = 0.25 * std::sin(0.21 * k + robot) + 0.05;
  if (Pose::kDim == 3) xi[3] = 0.3 * std::cos(0.13 * k);
  if (Pose::kDim == 3) xi[4] = 0.2 * std::sin(0.17 * k + 2.0 * robot);
  return xi;
}

template <class Pose>
RangeGraph<Pose> simulated_ranges(const RangeWorld& world) {
  Random random(world.seed);
  RangeGraph<Pose> graph;
  for (int robot = 0; robot < world.robots; ++robot) {
    typename Pose::Tangent start = Pose::Tangent::Zero();
    for (int i = 0; i < Pose::kDim; ++i) start[i] = random.uniform(-10.0, 10.0);
    start[Pose::kDof - 1] = random.uniform(-3.0, 3.0);
    Pose pose = Pose::exp(start);
    for (int k = 0; k < world.poses; ++k) {
      const auto name = std::string(1, static_cast<char>('A' + robot)) + std::to_string(k);
      const Index node = add_node(graph, name, pose, false, k);
      const Pose step = Pose::exp(motion<Pose>(robot, k));
      pose = pose * step;
      if (k + 1 == world.poses) break;
      const auto information = (Pose::Matrix::Identity() / std::pow(world.odometry, 2)).eval();
      graph.steps.push_back(
          {node, node + 1, step * Pose::exp(noise_of<Pose>(random, world.odometry)), information});
    }
  }
  const Index poses = graph.node_count();
  for (int b = 0; b < world.beacons; ++b) {
    typename Pose::Tangent place = Pose::Tangent::Zero();
    for (int i = 0; i < Pose::kDim; ++i) place[i] = random.uniform(-25.0, 25.0);
    add_node(graph, "L" + std::to_string(b), Pose::exp(place), true,
             std::numeric_limits<double>::quiet_NaN());
  }
  for (int k = 0; k < world.ranges; ++k) {
    const auto from = static_cast<Index>(random.index(static_cast<std::uint64_t>(poses)));
    Index to = from;
    if (world.beacons > 0 && (world.robots == 1 || k % 2 == 0)) {
      to = poses + static_cast<Index>(random.index(static_cast<std::uint64_t>(world.beacons)));
    } else {
      const Index other =
          static_cast<Index>(1 + random.index(static_cast<std::uint64_t>(world.robots - 1)));
      to = (from + other * world.poses) % poses;  // at the same time
    }
    const double distance =
        (graph.positions[from].translation() - graph.positions[to].translation()).norm();
    graph.ranges.push_back({from, to, std::max(0.0, distance + random.normal(0.0, world.noise)),
                            world.noise * world.noise, graph.stamps[from]});
  }
  return graph;
}

/// Root mean square distance of all nodes from the truth, once the first pose is where it is.
template <class Pose>
double error_from_first_pose(const RangeGraph<Pose>& truth, const std::vector<Pose>& poses) {
  const Pose T_true_found = truth.positions[0] * poses[0].inverse();
  double sum = 0.0;
  for (std::size_t v = 0; v < poses.size(); ++v) {
    const Pose moved = T_true_found * poses[v];
    sum += (moved.translation() - truth.positions[v].translation()).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(poses.size()));
}

}  // namespace isotherm_test
