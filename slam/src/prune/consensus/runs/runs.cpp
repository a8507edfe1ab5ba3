#include "prune/consensus/runs/runs.hpp"

#include <cstdlib>
#include <limits>
#include <tuple>
#include <utility>

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
  followers_.resize(loops.size());
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const Index led_by = leader(static_cast<Index>(k));
    if (led_by != kNone) followers_[led_by].push_back(static_cast<Index>(k));
  }
}

template <class Pose>
std::vector<Index> Runs<Pose>::leaders() const {
  std::vector<Index> leaders;
  for (std::size_t k = 0; k < before_.size(); ++k) {
    const Index led_by = leader(static_cast<Index>(k));
    if (led_by != kNone) leaders.push_back(led_by);
  }
  return leaders;
}

template class Runs<Pose2>;
template class Runs<Pose3>;

}  // namespace isotherm::slam::detail
