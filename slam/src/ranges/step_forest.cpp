#include "ranges/step_forest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace isotherm::slam::detail {
namespace {

template <class Pose>
std::vector<double> ranks(const RangeGraph<Pose>& graph) {
  const auto n = static_cast<std::size_t>(graph.node_count());
  bool stamped = true;
  for (std::size_t v = 0; v < n; ++v) {
    stamped = stamped && (graph.is_point[v] || !std::isnan(graph.stamps[v]));
  }
  std::vector<double> rank(n);
  for (std::size_t v = 0; v < n; ++v) {
    rank[v] = graph.is_point[v] ? -std::numeric_limits<double>::infinity()
              : stamped         ? graph.stamps[v]
                                : static_cast<double>(v);
  }
  return rank;
}

}  // namespace

template <class Pose>
StepForest<Pose> step_forest(const RangeGraph<Pose>& graph) {
  const auto n = static_cast<std::size_t>(graph.node_count());
  std::vector<std::vector<std::size_t>> steps_at(n);
  for (std::size_t k = 0; k < graph.steps.size(); ++k) {
    steps_at[graph.steps[k].from].push_back(k);
    steps_at[graph.steps[k].to].push_back(k);
  }
  StepForest<Pose> forest;
  forest.rank = ranks(graph);
  forest.links.resize(n);
  std::vector<Index> by_rank(n);
  std::iota(by_rank.begin(), by_rank.end(), 0);
  std::ranges::stable_sort(by_rank, {}, [&](Index v) { return forest.rank[v]; });
  std::vector<bool> reached(n, false);
  for (const Index root : by_rank) {
    if (reached[root]) continue;
    reached[root] = true;
    forest.order.push_back(root);
    for (std::size_t next = forest.order.size() - 1; next < forest.order.size(); ++next) {
      const Index parent = forest.order[next];
      for (const std::size_t k : steps_at[parent]) {
        const auto& step = graph.steps[k];
        const bool forward = step.from == parent;
        const Index child = forward ? step.to : step.from;
        if (reached[child]) continue;
        reached[child] = true;
        forest.links[child] = {parent, forward ? step.T_from_to : step.T_from_to.inverse()};
        forest.order.push_back(child);
      }
    }
  }
  return forest;
}

template StepForest<Pose2> step_forest(const RangeGraph<Pose2>&);
template StepForest<Pose3> step_forest(const RangeGraph<Pose3>&);

}  // namespace isotherm::slam::detail
