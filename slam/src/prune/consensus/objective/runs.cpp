#include "prune/consensus/objective/runs.hpp"

#include <cstdlib>
#include <limits>
#include <tuple>
#include <utility>

#include "isotherm/base/parallel.hpp"
#include "prune/consensus/estimate/log_normal.hpp"
#include "prune/consensus/pairs/loop_pair.hpp"
#include "prune/consensus/pairs/near_pairs.hpp"

namespace isotherm::slam::detail {

template <class Pose>
Runs<Pose>::Runs(const ReducedGraph<Pose>& graph, Index window)
    : before_(graph.loops.size(), kNone), copied_(graph.loops.size(), false) {
  const auto loops = forward_loops(graph, {});
  std::vector<Index> nearest(loops.size(), std::numeric_limits<Index>::max());
  // By place, not by the order of the file.
  const auto place = [&loops](Index k) { return std::tuple(loops[k].from, loops[k].to, k); };
  for (const auto& pair : near_pairs(graph, window)) {
    const auto [first, second] =
        place(pair.first) < place(pair.second) ? pair : std::pair(pair.second, pair.first);
    const Index apart = std::abs(loops[first].from - loops[second].from) +
                        std::abs(loops[first].to - loops[second].to);
    if (apart > nearest[second]) continue;
    nearest[second] = apart;
    before_[second] = first;
    copied_[second] = is_copy(graph.loops[first], graph.loops[second]);
  }
}

template <class Pose>
std::vector<double> Runs<Pose>::log_density(const ReducedGraph<Pose>& graph,
                                            const CovarianceScale& scale, int threads) const {
  const auto loops = forward_loops(graph, scale);
  std::vector<double> densities(loops.size(), 0.0);
  parallel_for_each(loops.size(), threads, [&](std::size_t k) {
    if (before_[k] == kNone) return;
    const auto [r, S] = pair_residual(graph, scale, loops[before_[k]], loops[k]);
    densities[k] = log_normal<Pose>(r, S);
  });
  return densities;
}

template class Runs<Pose2>;
template class Runs<Pose3>;

}  // namespace isotherm::slam::detail
