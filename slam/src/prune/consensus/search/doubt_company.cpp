#include <vector>

#include "prune/consensus/search/search.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr int kMajority = 2;  // of refuted neighbours over accepted ones

}  // namespace

// False loops come in runs, and a few of a run may be near enough to the truth to pass: loops
// among refuted ones must fit better than others.
template <class Pose>
void Search<Pose>::doubt_company() {
  std::vector<int> majority(accepted_.size(), 0);
  const auto count = [&](Index loop, Index neighbour) {
    if (accepted_[neighbour]) --majority[loop];
    if (judge_.refuted(neighbour)) ++majority[loop];
  };
  for (const auto& [first, second] : near_pairs_) {
    count(first, second);
    count(second, first);
  }
  Selection doubtful;
  for (std::size_t k = 0; k < majority.size(); ++k) {
    if (majority[k] >= kMajority) doubtful.push_back(static_cast<Index>(k));
  }
  judge_.doubt(doubtful);
}

template void Search<Pose2>::doubt_company();
template void Search<Pose3>::doubt_company();

}  // namespace isotherm::slam::detail
