#include "localize/placing.hpp"

#include <algorithm>
#include <cmath>

#include "localize/multilateration.hpp"

namespace isotherm::geometry::detail {
namespace {

// The node, last, with its placed neighbours and the pairs that lead to them.
SmallNetwork star(const RangeProblem& problem, const Placement& placement, Index node) {
  std::vector<Index> members;
  SmallNetwork network;
  for (const auto& [vertex, edge] : problem.pair_graph.neighbours(node)) {
    if (!placement.placed[vertex]) continue;
    const auto& pair = problem.pairs[edge];
    network.ranges.push_back({static_cast<int>(members.size()), 0, pair.distance, pair.sigma});
    members.push_back(vertex);
  }
  for (auto& range : network.ranges) range.to = static_cast<int>(members.size());
  members.push_back(node);
  network.positions = placement.positions(Eigen::all, members);
  network.fixed = static_cast<int>(members.size()) - 1;
  return network;
}

int agreeing(const SmallNetwork& network, double gate) {
  return static_cast<int>(std::count_if(
      network.ranges.begin(), network.ranges.end(),
      [&](const SmallRange& range) { return std::pow(deviation(network, range), 2) <= gate; }));
}

bool try_to_place(const RangeProblem& problem, double gate, double mirror_gate, Index node,
                  Placement& placement) {
  auto network = star(problem, placement, node);
  if (network.fixed <= problem.dimension) return false;
  const auto found = multilaterate(network, gate);
  if (!found || found->rival_cost - found->cost < mirror_gate) return false;
  network.positions.col(network.fixed) = found->position;
  if (agreeing(network, gate) <= problem.dimension) return false;
  placement.positions.col(node) = found->position;
  placement.placed[node] = true;
  return true;
}

}  // namespace

Index place_more(const RangeProblem& problem, double gate, double mirror_gate,
                 Placement& placement) {
  Index placed = 0;
  for (bool any = true; any;) {
    any = false;
    std::vector<std::pair<Index, Index>> order;  // minus the placed neighbours, node
    for (Index v = 0; v < problem.nodes; ++v) {
      if (placement.placed[v]) continue;
      Index count = 0;
      for (const auto& neighbour : problem.pair_graph.neighbours(v)) {
        if (placement.placed[neighbour.vertex]) ++count;
      }
      if (count > problem.dimension) order.emplace_back(-count, v);
    }
    std::sort(order.begin(), order.end());
    for (const auto& [count, node] : order) {
      if (!try_to_place(problem, gate, mirror_gate, node, placement)) continue;
      ++placed;
      any = true;
    }
  }
  return placed;
}

Index relocate(const RangeProblem& problem, double gate, Placement& placement) {
  constexpr double kGain = 2.0;  // of the cost, for which a move is worth it
  Index moved = 0;
  for (Index v = 0; v < problem.nodes; ++v) {
    if (!placement.placed[v] || problem.is_anchor[v]) continue;
    const auto network = star(problem, placement, v);
    const auto count = static_cast<int>(network.ranges.size());
    if (count <= problem.dimension || agreeing(network, gate) == count) continue;
    const auto found = multilaterate(network, gate);
    if (!found || truncated_cost(network, gate) - found->cost < kGain) continue;
    placement.positions.col(v) = found->position;
    ++moved;
  }
  return moved;
}

std::vector<bool> fits_elsewhere(const RangeProblem& problem, double gate, double mirror_gate,
                                 const Placement& placement) {
  std::vector<bool> result(problem.nodes, false);
  // Without anchors a simplex may be mirrored as it is.
  const auto placed = std::count(placement.placed.begin(), placement.placed.end(), true);
  if (!problem.anchored() && placed <= problem.dimension + 1) return result;
  for (Index v = 0; v < problem.nodes; ++v) {
    if (!placement.placed[v] || problem.is_anchor[v]) continue;
    const auto network = star(problem, placement, v);
    const auto found = multilaterate(network, gate);
    result[v] = found && found->rival_cost - found->cost < mirror_gate;
  }
  return result;
}

}  // namespace isotherm::geometry::detail
