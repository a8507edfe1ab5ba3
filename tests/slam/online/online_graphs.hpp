#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "isotherm/base/random.hpp"
#include "isotherm/slam/online/online_consensus.hpp"
#include "isotherm/slam/simulate/corrupt.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm_test {

using namespace isotherm;
using namespace isotherm::slam;

/// Half as many false loops as true ones, or as many times more, each behind the odometry that it
/// needs.
template <class Pose>
PoseGraph<Pose> corrupted_graph(std::uint64_t seed, int poses = 60, int loops = 24,
                                double ratio = 0.5) {
  Random random(seed);
  const auto made = random_loop_graph<Pose>(random, poses, loops, 1.0);
  CorruptOptions options;
  options.ratio = ratio;
  options.seed = seed;
  auto graph = corrupt(made.graph, made.truth, options).graph;
  graph.poses.clear();
  // Which of two edges between neighbours is the step must not depend on their order.
  for (auto& edge : graph.constraints) edge.link = LinkKind::loop;
  for (const Index k : edge_roles(made.graph).odometry) {
    const auto& step = made.graph.constraints[k];
    for (auto& edge : graph.constraints) {
      const bool same = edge.from == step.from && edge.to == step.to &&
                        edge.T_from_to.log() == step.T_from_to.log();
      if (same) edge.link = LinkKind::odometry;
    }
  }
  std::ranges::stable_sort(graph.constraints, {},
                           [](const auto& edge) { return std::max(edge.from, edge.to); });
  return graph;
}

template <class Pose>
std::vector<LoopChange> add(OnlineConsensus<Pose>& online, const PoseGraph<Pose>& graph,
                            const Constraint<Pose>& edge) {
  return online.add_edge(graph.ids[edge.from], graph.ids[edge.to], edge.T_from_to, edge.information,
                         edge.link);
}

template <class Pose>
std::vector<LoopChange> add_all(OnlineConsensus<Pose>& online, const PoseGraph<Pose>& graph) {
  std::vector<LoopChange> all;
  for (const auto& edge : graph.constraints) {
    for (auto& change : add(online, graph, edge)) all.push_back(std::move(change));
  }
  return all;
}

}  // namespace isotherm_test
