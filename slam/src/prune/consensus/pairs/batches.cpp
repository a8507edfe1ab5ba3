#include "prune/consensus/pairs/batches.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "graph/find_root.hpp"

namespace isotherm::slam::detail {
namespace {

// Groups with this share of the strongest one's log odds are accepted with it.
constexpr double kStrong = 0.7;

// The roots of both ends of a link; those of one and the same group, and of loops that are
// not eligible, are no two groups to join.
std::optional<std::pair<Index, Index>> two_groups(std::vector<Index>& parent, const Support& link) {
  if (parent[link.first] < 0 || parent[link.second] < 0) return std::nullopt;
  const Index a = find_root(parent, link.first);
  const Index b = find_root(parent, link.second);
  if (a == b) return std::nullopt;
  return std::pair(a, b);
}

}  // namespace

std::vector<Index> most_certain_third(std::vector<Index> passing,
                                      const std::vector<double>& log_odds, double expected_false) {
  std::stable_sort(passing.begin(), passing.end(),
                   [&](Index a, Index b) { return log_odds[a] > log_odds[b]; });
  const std::size_t third = (passing.size() + 2) / 3;
  std::size_t size = 0;
  double sum = 0.0;
  for (; size < passing.size(); ++size) {
    sum += 1.0 / (1.0 + std::exp(log_odds[passing[size]]));
    if (size >= third && sum > expected_false) break;
  }
  passing.resize(size);
  return passing;
}

std::vector<std::vector<Index>> agreeing_groups(const MutualSupport& support,
                                                const std::vector<Index>& eligible,
                                                std::size_t loop_count) {
  std::vector<Index> parent(loop_count, -1);
  for (const Index k : eligible) parent[k] = k;
  for (const auto* links : {&support.copied, &support.agreeing}) {
    for (const auto& link : *links) {
      const auto roots = two_groups(parent, link);
      if (!roots) continue;
      const auto [a, b] = *roots;
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  std::vector<std::vector<Index>> group_of_root(loop_count);
  for (const Index k : eligible) group_of_root[find_root(parent, k)].push_back(k);
  std::erase_if(group_of_root, [](const auto& group) { return group.empty(); });
  return group_of_root;
}

void largest_first(std::vector<std::vector<Index>>& groups) {
  std::ranges::stable_sort(groups,
                           [](const auto& a, const auto& b) { return a.size() > b.size(); });
}

std::vector<Index> strongest_clusters(const MutualSupport& support,
                                      const std::vector<Index>& eligible,
                                      const std::vector<double>& log_odds,
                                      const Agreement& agreement, double required_odds) {
  std::vector<Index> parent(log_odds.size(), -1);
  std::vector<double> best(log_odds.size(), 0.0);
  std::vector<double> added(log_odds.size(), 0.0);
  for (const Index k : eligible) {
    parent[k] = k;
    best[k] = log_odds[k];
  }
  const auto join = [&](const Support& link, double gain) {
    const auto roots = two_groups(parent, link);
    if (!roots) return;
    const auto [a, b] = *roots;
    parent[b] = a;
    best[a] = std::max(best[a], best[b]);
    added[a] += added[b] + gain;
  };
  // Copies first: what agrees with one of them agrees with all, which counts once.
  for (const auto& link : support.copied) join(link, 0.0);
  const double cap = -std::log(agreement.alike_fraction);
  for (const auto& link : support.agreeing) {
    if (link.gain > 0.0 && link.chi2 <= agreement.most_chi2) join(link, std::min(link.gain, cap));
  }
  double strongest = required_odds;
  for (const Index k : eligible) {
    if (parent[k] == k) strongest = std::max(strongest, best[k] + added[k]);
  }
  std::vector<Index> chosen;
  for (const Index k : eligible) {
    const Index root = find_root(parent, k);
    const double score = best[root] + added[root];
    if (score >= required_odds && score >= kStrong * strongest) chosen.push_back(k);
  }
  return chosen;
}

}  // namespace isotherm::slam::detail
