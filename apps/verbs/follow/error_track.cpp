#include "verbs/follow/error_track.hpp"

#include "isotherm/base/error.hpp"
#include "verbs/input/truth_input.hpp"

namespace isotherm::apps {

using namespace slam;

template <class Pose>
ErrorTrack<Pose>::ErrorTrack(const PoseGraph<Pose>& whole, const GroundTruthSource& source,
                             const CommonFlags& flags) {
  const auto truth = read_truth(whole, source, flags);
  for (std::size_t v = 0; v < truth.size(); ++v) {
    if (truth[v]) truth_.emplace(whole.ids[v], *truth[v]);
  }
}

template <class Pose>
std::optional<double> ErrorTrack<Pose>::ate(const PoseGraph<Pose>& now,
                                            const std::set<VertexId>& come) {
  PosePairs<Pose> pairs;
  for (std::size_t v = 0; v < now.poses.size(); ++v) {
    const auto known = truth_.find(now.ids[v]);
    if (known == truth_.end() || !come.contains(now.ids[v])) continue;
    pairs.estimate.push_back(now.poses[v]);
    pairs.truth.push_back(known->second);
  }
  try {
    const double error = absolute_trajectory_error(pairs, Alignment::se).rmse;
    sum_ += error;
    ++count_;
    return error;
  } catch (const InvalidArgument&) {
    return std::nullopt;
  }
}

template <class Pose>
std::optional<double> ErrorTrack<Pose>::mean() const {
  if (count_ == 0) return std::nullopt;
  return sum_ / static_cast<double>(count_);
}

template class ErrorTrack<Pose2>;
template class ErrorTrack<Pose3>;

}  // namespace isotherm::apps
