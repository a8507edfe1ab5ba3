#include "localize/evidence/placing.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "isotherm/base/parallel.hpp"
#include "localize/evidence/crowd.hpp"
#include "localize/evidence/multilateration.hpp"
#include "localize/evidence/star.hpp"

namespace isotherm::network::detail {
namespace {

bool try_to_place(const RangeProblem& problem, double gate, const Evidence& evidence, Index node,
                  Placement& placement) {
  constexpr double kClear = 2.0;  // a first look; later ones ask for more
  auto network = star(problem, placement, node);
  if (network.fixed <= problem.dimension) return false;
  const auto found = multilaterate(network, evidence.limits);
  if (!found || found->rival_cost - found->cost < kClear) return false;
  network.positions.col(network.fixed) = found->position;
  if (agreeing(network, gate) <= problem.dimension) return false;
  placement.positions.col(node) = found->position;
  placement.placed[node] = true;
  return true;
}

// Unplaced nodes with more than d placed neighbours, those with the most first.
std::vector<Index> next_to_place(const RangeProblem& problem, const Placement& placement) {
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
  std::vector<Index> nodes;
  for (const auto& entry : order) nodes.push_back(entry.second);
  return nodes;
}

}  // namespace

void place_more(const RangeProblem& problem, double gate, const Evidence& evidence,
                Placement& placement) {
  for (bool any = true; any;) {
    any = false;
    for (const Index node : next_to_place(problem, placement)) {
      any = try_to_place(problem, gate, evidence, node, placement) || any;
    }
  }
}

std::vector<Index> relocate(const RangeProblem& problem, double gate, const Evidence& evidence,
                            const LocalizeOptions& options, const std::vector<bool>& among,
                            Placement& placement) {
  constexpr double kGain = 2.0;  // of the cost, for which a move is worth it
  Crowd crowd(problem, placement, evidence.absence);
  const auto surroundings = [&](Index node) {
    auto network = star(problem, placement, node);
    crowd.add_strangers(network, node, placement.placed);
    return network;
  };
  std::vector<Index> suspects;
  for (Index v = 0; v < problem.nodes; ++v) {
    if (!among[v] || !placement.placed[v] || problem.is_anchor[v]) continue;
    const auto network = star(problem, placement, v);
    const auto count = static_cast<int>(network.ranges.size());
    if (count <= problem.dimension) continue;
    const Point place = placement.positions.col(v);
    if (agreeing(network, gate) < count || crowd.absence_cost(v, place, placement.placed) > kGain) {
      suspects.push_back(v);
    }
  }
  std::vector<std::optional<Multilateration>> found(suspects.size());
  parallel_for(static_cast<std::int64_t>(suspects.size()), options.threads, options.progress,
               "multilateration", [&](std::int64_t k) {
                 found[k] = multilaterate(surroundings(suspects[k]), evidence.limits);
               });
  std::vector<Index> moved;
  for (std::size_t k = 0; k < suspects.size(); ++k) {
    if (!found[k]) continue;
    // Neighbours may have moved in the meantime: both places are judged anew.
    auto network = surroundings(suspects[k]);
    const double before = place_cost(network, evidence.limits);
    network.positions.col(network.fixed) = found[k]->position;
    if (before - place_cost(network, evidence.limits) < kGain) continue;
    placement.positions.col(suspects[k]) = found[k]->position;
    moved.push_back(suspects[k]);
  }
  return moved;
}

}  // namespace isotherm::network::detail
