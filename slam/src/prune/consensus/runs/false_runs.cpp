#include "prune/consensus/runs/false_runs.hpp"

#include <cmath>

#include "prune/consensus/constants.hpp"
#include "prune/consensus/log_sum.hpp"

namespace isotherm::slam::detail {

template <class Pose>
std::vector<double> log_follows(const Runs<Pose>& runs, const std::vector<bool>& accepted,
                                std::span<const double> log_led) {
  std::vector<double> follows(accepted.size(), 0.0);
  for (std::size_t k = 0; k < follows.size(); ++k) {
    const Index before = runs.leader(static_cast<Index>(k));
    if (before == Runs<Pose>::kNone || accepted[k] || accepted[before]) continue;
    follows[k] = log_sum(std::log1p(-kFalseFollowing), std::log(kFalseFollowing) + log_led[k]);
  }
  return follows;
}

template std::vector<double> log_follows(const Runs<Pose2>&, const std::vector<bool>&,
                                         std::span<const double>);
template std::vector<double> log_follows(const Runs<Pose3>&, const std::vector<bool>&,
                                         std::span<const double>);

}  // namespace isotherm::slam::detail
