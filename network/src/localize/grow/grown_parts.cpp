#include "localize/grow/grown_parts.hpp"

#include <algorithm>
#include <utility>

#include "localize/evidence/agreement.hpp"
#include "localize/grow/grow.hpp"
#include "localize/patches/seeds.hpp"
#include "localize/refine/robust_refine.hpp"

namespace isotherm::network::detail {
namespace {

class Nursery {
 public:
  Nursery(const RangeProblem& problem, const std::vector<bool>& trusted, double gate,
          const Evidence& evidence, const LocalizeOptions& options)
      : problem_(problem), trusted_(trusted), gate_(gate), evidence_(evidence), options_(options) {}

  // Maps grown from seeds until there is none outside them, the largest first.
  std::vector<Placement> run() const {
    constexpr std::size_t kMostParts = 12;
    std::vector<Placement> parts;
    std::vector<bool> covered(problem_.nodes, false);
    const auto seeds = consistent_cliques(problem_, trusted_, gate_, options_);
    while (parts.size() < kMostParts) {
      auto map = best_map(sprouts(seeds, covered));
      if (map.placed.empty()) break;
      for (Index v = 0; v < problem_.nodes; ++v) covered[v] = covered[v] || map.placed[v];
      parts.push_back(std::move(map));
    }
    std::stable_sort(parts.begin(), parts.end(), [](const Placement& a, const Placement& b) {
      return placed_count(a) > placed_count(b);
    });
    return parts;
  }

 private:
  // Small maps grown from seeds in different places outside `covered`.
  std::vector<Placement> sprouts(const std::vector<Patch>& seeds, std::vector<bool> covered) const {
    constexpr std::size_t kMost = 8;
    constexpr Index kSize = 60;
    std::vector<Placement> maps;
    for (const auto& seed : seeds) {
      const auto known = std::count_if(seed.members.begin(), seed.members.end(),
                                       [&](Index v) { return covered[v]; });
      if (2 * known > static_cast<std::ptrdiff_t>(seed.members.size())) continue;
      if (maps.size() == kMost) break;
      maps.push_back(place_nodes(problem_, seed.members, seed.positions));
      for (const Index v : seed.members) covered[v] = true;
      grow(problem_, trusted_, gate_, evidence_, options_, maps.back(), kSize);
    }
    return maps;
  }

  // The few whose pairs fit best of the maps at least half as large as the largest are
  // grown to the end; the one that explains most of them.
  Placement best_map(std::vector<Placement> maps) const {
    constexpr std::size_t kFinalists = 3;
    std::vector<std::pair<double, std::size_t>> order;
    Index largest = 0;
    for (const auto& map : maps) largest = std::max(largest, placed_count(map));
    for (std::size_t k = 0; k < maps.size(); ++k) {
      const auto found = agreement(problem_, trusted_, gate_, maps[k]);
      if (2 * placed_count(maps[k]) >= largest) order.emplace_back(found.cost_per_pair(), k);
    }
    std::sort(order.begin(), order.end());
    Placement best;
    double best_credit = 0.0;
    for (std::size_t k = 0; k < std::min(kFinalists, order.size()); ++k) {
      auto& map = maps[order[k].second];
      grow(problem_, trusted_, gate_, evidence_, options_, map);
      refine_robustly(problem_, trusted_, gate_, options_, map);
      const double credit = agreement(problem_, trusted_, gate_, map).credit;
      if (!best.placed.empty() && credit <= best_credit) continue;
      best = std::move(map);
      best_credit = credit;
    }
    return best;
  }

  const RangeProblem& problem_;
  const std::vector<bool>& trusted_;
  double gate_;
  const Evidence& evidence_;
  const LocalizeOptions& options_;
};

}  // namespace

std::vector<Placement> grown_parts(const RangeProblem& problem, const std::vector<bool>& trusted,
                                   double gate, const Evidence& evidence,
                                   const LocalizeOptions& options) {
  return Nursery(problem, trusted, gate, evidence, options).run();
}

}  // namespace isotherm::network::detail
