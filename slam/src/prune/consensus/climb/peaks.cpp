#include "prune/consensus/climb/peaks.hpp"

#include "prune/consensus/constants.hpp"

namespace isotherm::slam::detail {

template <class Pose>
void Peaks<Pose>::pass(const Explanation<Pose>& now) {
  passed_.push_back({now.accepted, now.scale, now.evidence, peaks_.size()});
}

template <class Pose>
const Explanation<Pose>* Peaks<Pose>::beyond(const Explanation<Pose>& now) const {
  for (const auto& [accepted, scale, evidence, peak] : passed_) {
    if (peak == peaks_.size() || now.accepted != accepted) continue;
    if (now.evidence <= evidence + kBetter && about_the_same(now.scale, scale)) {
      return &peaks_[peak];
    }
  }
  return nullptr;
}

template <class Pose>
const Explanation<Pose>& Peaks<Pose>::end_at_known(const Explanation<Pose>& peak) {
  for (Passed& passed : passed_) {
    if (passed.peak == peaks_.size()) passed.peak = static_cast<std::size_t>(&peak - peaks_.data());
  }
  return peak;
}

template class Peaks<Pose2>;
template class Peaks<Pose3>;

}  // namespace isotherm::slam::detail
