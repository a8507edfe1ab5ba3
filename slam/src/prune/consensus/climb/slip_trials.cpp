#include "prune/consensus/climb/slip_trials.hpp"

#include <algorithm>
#include <utility>

#include "prune/consensus/climb/groups.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr int kMostInVain = 8;  // trials in a row

}  // namespace

template <class Pose>
bool SlipTrials<Pose>::as_if_accurate() {
  const double least = at_.now.evidence + kBetter;
  return at_.all_or_nothing([&] {
    const ScaleShares shares = std::exchange(at_.now.shares, all_as_most(at_.now.shares));
    at_.now.weights.assign(at_.now.weights.size(), {});
    at_.now.shapes.odometry.setOnes();
    at_.assess();
    const bool found = at_.take_slips(decisive_);
    at_.now.shares = shares;
    if (!found) return false;
    moves_.settle();
    return at_.now.evidence > least;
  });
}

// Until eight in a row do not gain.
template <class Pose>
bool SlipTrials<Pose>::for_rejected_runs() {
  bool any = false;
  int vain = 0;
  for (const Selection& loops : rejected_runs()) {
    const Index first = loops.front();
    if (at_.now.accepted[first] || !at_.now.standings[first].connected()) continue;
    const bool gains = for_run(loops);
    any = any || gains;
    vain = gains ? 0 : vain + 1;
    if (vain == kMostInVain) break;
  }
  return any;
}

// Whether it gains that these are true, and odometry slips otherwise. Else it is what explains that
// best, and how much worse that is says how likely it is.
template <class Pose>
bool SlipTrials<Pose>::for_run(const Selection& loops) {
  const double least = at_.now.evidence + kBetter;
  return at_.all_or_nothing([&] {
    std::fill(at_.dropped.begin(), at_.dropped.end(), false);
    at_.take_as(loops, true);
    at_.assess();
    const bool slips = at_.try_best_slips(0.0);
    Explanation<Pose> best = at_.now;
    while (slips && at_.now.evidence <= least && (at_.try_best_slips(0.0) || moves_.shift())) {
      if (at_.now.accepted[loops.front()] && at_.now.evidence > best.evidence) best = at_.now;
    }
    if (at_.now.evidence > least) return true;
    doubted_.push_back(std::move(best));
    return false;
  });
}

template <class Pose>
std::vector<typename SlipTrials<Pose>::Selection> SlipTrials<Pose>::rejected_runs() const {
  auto runs = groups_of(at_.assessment, at_.now, at_.open());
  std::ranges::stable_sort(runs, std::greater{}, &Group::gain);
  std::vector<Selection> loops;
  for (Group& run : runs) loops.push_back(std::move(run.loops));
  return loops;
}

template class SlipTrials<Pose2>;
template class SlipTrials<Pose3>;

}  // namespace isotherm::slam::detail
