#include <algorithm>
#include <utility>

#include "prune/consensus/pairs/batches.hpp"
#include "prune/consensus/search/search.hpp"

namespace isotherm::slam::detail {
namespace {

// So many groups elsewhere must be proven: of hundreds of false loops one or the other
// fits any way of joining two parts.
constexpr std::size_t kFewestWitnesses = 3;

}  // namespace

// Loops between parts that nothing joins have no evidence, and of groups that agree one
// may be as strong as the other. So the largest groups are accepted in turn on trial:
// the one stays that lets most others, which do not agree with it by themselves, be
// proven.
template <class Pose>
bool Search<Pose>::join_on_trial() {
  Selection apart;
  for (const Index k : in_question()) {
    if (!judge_.connected(k)) apart.push_back(k);
  }
  auto groups = agreeing_groups(support_, apart, accepted_.size());
  if (groups.size() <= kFewestWitnesses) return false;
  largest_first(groups);
  const Snapshot before = snapshot();
  std::size_t most = 0;
  std::size_t best = 0;
  for (std::size_t k = 0; k < std::min(groups.size(), kMostTrials); ++k) {
    const std::size_t found = witnesses(groups, k);
    restore(before);
    if (found > most) best = k;
    most = std::max(most, found);
  }
  settle();
  if (most < kFewestWitnesses) return false;
  return accept({"trial", groups[best]});
}

// Groups of which a member is proven once `groups[tried]` is accepted, as it is then.
template <class Pose>
std::size_t Search<Pose>::witnesses(const std::vector<Selection>& groups, std::size_t tried) {
  accept({"trial", groups[tried]});
  settle();
  assess();
  std::size_t count = 0;
  for (std::size_t k = 0; k < groups.size(); ++k) {
    if (k == tried) continue;
    count += std::ranges::any_of(groups[k], [this](Index loop) {
      return !accepted_[loop] && judge_.connected(loop) && judge_.inside_gate(loop) &&
             judge_.log_odds(loop, judge_.evidence(loop)) >= required_odds_;
    });
  }
  return count;
}

template bool Search<Pose2>::join_on_trial();
template std::size_t Search<Pose2>::witnesses(const std::vector<Selection>&, std::size_t);
template bool Search<Pose3>::join_on_trial();
template std::size_t Search<Pose3>::witnesses(const std::vector<Selection>&, std::size_t);

}  // namespace isotherm::slam::detail
