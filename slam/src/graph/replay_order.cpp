#include "isotherm/slam/graph/replay_order.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace isotherm::slam {
namespace {

constexpr VertexId kNumber = (VertexId{1} << 56) - 1;  // below the robot's letter

}  // namespace

template <class Pose>
std::vector<Index> replay_order(const PoseGraph<Pose>& graph) {
  std::vector<bool> step(graph.constraints.size(), false);
  for (const Index k : edge_roles(graph).odometry) step[k] = true;
  const auto time = [&](Index k) {
    const auto& edge = graph.constraints[k];
    const VertexId last = std::max(graph.ids[edge.from] & kNumber, graph.ids[edge.to] & kNumber);
    return std::pair(last, !step[k]);
  };
  std::vector<Index> order(graph.constraints.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, time);
  return order;
}

template <class Pose>
PoseGraph<Pose> in_replay_order(PoseGraph<Pose> graph) {
  std::vector<Constraint<Pose>> sorted;
  sorted.reserve(graph.constraints.size());
  for (const Index k : replay_order(graph)) sorted.push_back(graph.constraints[k]);
  graph.constraints = std::move(sorted);
  return graph;
}

template std::vector<Index> replay_order(const PoseGraph<Pose2>&);
template std::vector<Index> replay_order(const PoseGraph<Pose3>&);
template PoseGraph<Pose2> in_replay_order(PoseGraph<Pose2>);
template PoseGraph<Pose3> in_replay_order(PoseGraph<Pose3>);

}  // namespace isotherm::slam
