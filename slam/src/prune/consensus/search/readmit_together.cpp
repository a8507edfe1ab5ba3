#include <algorithm>
#include <utility>

#include "prune/consensus/judge/log_odds.hpp"
#include "prune/consensus/pairs/batches.hpp"
#include "prune/consensus/search/search.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr double kNearlyInside = 2.0;  // times the gate
constexpr double kLikely = 0.99;       // that the group is true; the map it ends with tells more

// Whether every loop of `few` is one of `many`.
bool contains(const std::vector<bool>& many, const std::vector<bool>& few) {
  return std::ranges::equal(few, many, [](bool a, bool b) { return !a || b; });
}

// The largest, where there are too many to try all.
void keep_trials(std::vector<std::vector<Index>>& groups) {
  std::erase_if(groups, [](const auto& group) { return group.size() < 2; });
  if (groups.size() <= kMostTrials) return;
  largest_first(groups);
  groups.resize(kMostTrials);
}

}  // namespace

// Where the map can give way, loops that say the same may each be refuted by a map without
// them and yet fit one with all of them. What then stays of such a group is readmitted if
// it drives nothing else out.
template <class Pose>
void Search<Pose>::readmit_together() {
  Selection near;
  for (std::size_t k = 0; k < accepted_.size(); ++k) {
    const auto loop = static_cast<Index>(k);
    if (judge_.connected(loop) && judge_.refuted(loop) &&
        judge_.evidence(loop).chi2 <= kNearlyInside * judge_.refuting_gate(loop)) {
      near.push_back(loop);
    }
  }
  near = strongest_clusters(support_, near, judge_.log_odds(), agreement_,
                            std::min(required_odds_, log_odds_of(kLikely)));
  bool any = false;
  auto groups = agreeing_groups(support_, near, accepted_.size());
  keep_trials(groups);
  for (const Selection& group : groups) {
    Snapshot before = snapshot();
    accept({"together", group});
    settle();
    if (before.accepted != accepted_ && contains(accepted_, before.accepted)) {
      any = true;
    } else {
      restore(std::move(before));
    }
  }
  if (any) accept_while_possible();
}

template void Search<Pose2>::readmit_together();
template void Search<Pose3>::readmit_together();

}  // namespace isotherm::slam::detail
