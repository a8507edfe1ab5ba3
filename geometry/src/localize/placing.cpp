#include "localize/placing.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "isotherm/base/parallel.hpp"
#include "localize/multilateration.hpp"
#include "localize/star.hpp"

namespace isotherm::geometry::detail {
namespace {

bool try_to_place(const RangeProblem& problem, double gate, double limit, Index node,
                  Placement& placement) {
  constexpr double kClear = 2.0;  // a first look; later ones ask for more
  auto network = star(problem, placement, node);
  if (network.fixed <= problem.dimension) return false;
  const auto found = multilaterate(network, limit);
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

double outlier_cost(const RangeProblem& problem, const std::vector<bool>& usable,
                    const Placement& placement, double gate) {
  constexpr double kLeast = 4.0;
  constexpr double kPeak = 0.3989;  // of the standard normal density
  double within = 0.5;
  double beyond = 0.5;
  for (std::size_t p = 0; p < problem.pairs.size(); ++p) {
    const auto& pair = problem.pairs[p];
    if (!usable[p] || !is_placed(placement, pair)) continue;
    (squared_deviation(placement, pair) <= gate ? within : beyond) += 1.0;
  }
  // A false range has any length up to about twice the usual one.
  const double span = 2.0 * problem.typical_distance / lower_median(problem.sigmas);
  return std::max(kLeast, 2.0 * std::log(within / beyond * kPeak * span));
}

void place_more(const RangeProblem& problem, double gate, Placement& placement) {
  for (bool any = true; any;) {
    any = false;
    for (const Index node : next_to_place(problem, placement)) {
      any = try_to_place(problem, gate, gate, node, placement) || any;
    }
  }
}

Index relocate(const RangeProblem& problem, double gate, const LocalizeOptions& options,
               Placement& placement) {
  constexpr double kGain = 2.0;  // of the cost, for which a move is worth it
  const std::vector<bool> all(problem.pairs.size(), true);
  const double limit = outlier_cost(problem, all, placement, gate);
  std::vector<Index> suspects;
  for (Index v = 0; v < problem.nodes; ++v) {
    if (!placement.placed[v] || problem.is_anchor[v]) continue;
    const auto network = star(problem, placement, v);
    const auto count = static_cast<int>(network.ranges.size());
    if (count > problem.dimension && agreeing(network, gate) < count) suspects.push_back(v);
  }
  std::vector<std::optional<Multilateration>> found(suspects.size());
  parallel_for(static_cast<std::int64_t>(suspects.size()), options.threads, options.progress,
               "multilateration", [&](std::int64_t k) {
                 found[k] = multilaterate(star(problem, placement, suspects[k]), limit);
               });
  Index moved = 0;
  for (std::size_t k = 0; k < suspects.size(); ++k) {
    if (!found[k]) continue;
    // Neighbours may have moved in the meantime: both places are judged anew.
    auto network = star(problem, placement, suspects[k]);
    const double before = truncated_cost(network, limit);
    network.positions.col(network.fixed) = found[k]->position;
    if (before - truncated_cost(network, limit) < kGain) continue;
    placement.positions.col(suspects[k]) = found[k]->position;
    ++moved;
  }
  return moved;
}

}  // namespace isotherm::geometry::detail
