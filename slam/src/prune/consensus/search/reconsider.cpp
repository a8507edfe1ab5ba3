#include <algorithm>
#include <utility>

#include "prune/consensus/search/search.hpp"

namespace isotherm::slam::detail {

// A false loop that joins two parts of the map before any true one does is contradicted
// by nothing that is accepted, and turns the true ones away. So loops that no others
// prove are put on trial: where more loops than these are consistent without them,
// the others come first, and the explanation that leaves more loops accepted stays.
template <class Pose>
bool Search<Pose>::reconsider() {
  const Selection suspects = judge_.held_by_themselves(required_odds_);
  if (suspects.empty()) return false;
  Snapshot before = snapshot();
  const std::int64_t explained = accepted_count();
  if (freed_without(suspects) <= suspects.size()) {
    restore(std::move(before));
    return false;
  }
  for (const Index k : suspects) records_[k].on_trial = true;
  accept_while_possible();
  for (const Index k : suspects) records_[k].on_trial = false;
  accept_while_possible();
  if (accepted_count() > explained) return true;
  restore(std::move(before));
  return false;
}

// Takes `loops` back; the number of refuted ones that nothing speaks against then.
template <class Pose>
std::size_t Search<Pose>::freed_without(const Selection& loops) {
  Selection turned_away;
  for (std::size_t k = 0; k < accepted_.size(); ++k) {
    if (judge_.refuted(static_cast<Index>(k))) turned_away.push_back(static_cast<Index>(k));
  }
  for (const Index k : loops) accepted_[k] = false;
  judge_.forget_bounds();
  settle();
  assess();
  return static_cast<std::size_t>(
      std::ranges::count_if(turned_away, [this](Index k) { return judge_.inside_gate(k); }));
}

template <class Pose>
typename Search<Pose>::Snapshot Search<Pose>::snapshot() const {
  return {judge_.standings(), records_, accepted_, rounds_.size(), estimate_.layout()};
}

template <class Pose>
void Search<Pose>::restore(Snapshot before) {
  judge_.restore(std::move(before.standings));
  records_ = std::move(before.records);
  accepted_ = std::move(before.accepted);
  rounds_.resize(before.rounds);
  estimate_.restore(std::move(before.layout));
}

template <class Pose>
std::int64_t Search<Pose>::accepted_count() const {
  return std::count(accepted_.begin(), accepted_.end(), true);
}

template bool Search<Pose2>::reconsider();
template std::size_t Search<Pose2>::freed_without(const Selection&);
template Search<Pose2>::Snapshot Search<Pose2>::snapshot() const;
template void Search<Pose2>::restore(Snapshot);
template std::int64_t Search<Pose2>::accepted_count() const;
template bool Search<Pose3>::reconsider();
template std::size_t Search<Pose3>::freed_without(const Selection&);
template Search<Pose3>::Snapshot Search<Pose3>::snapshot() const;
template void Search<Pose3>::restore(Snapshot);
template std::int64_t Search<Pose3>::accepted_count() const;

}  // namespace isotherm::slam::detail
