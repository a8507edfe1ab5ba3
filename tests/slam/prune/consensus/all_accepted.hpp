#pragma once

#include <vector>

#include "prune/consensus/objective/objective.hpp"

namespace isotherm_test {

/// That all loops are true and as accurate as stated, at these factors, where they and odometry
/// agree best.
template <class Pose>
class AllAccepted {
 public:
  AllAccepted(const isotherm::slam::detail::Objective<Pose>& objective,
              const isotherm::slam::detail::CovarianceScale& scale,
              const isotherm::slam::detail::Shapes<Pose>& shapes)
      : objective_(objective),
        explanation_{.accepted = std::vector<bool>(objective.stated().reduced.loops.size(), true),
                     .scale = scale,
                     .shapes = shapes},
        graph_(objective.scaled(shapes)),
        estimate_(graph_.reduced) {
    explanation_.weights.resize(explanation_.accepted.size());
    estimate_.update(explanation_.accepted, scale, 20);
  }

  AllAccepted(const AllAccepted&) = delete;  // the estimate is of this one's graph
  AllAccepted& operator=(const AllAccepted&) = delete;

  const auto& explanation() const { return explanation_; }
  const auto& graph() const { return graph_; }
  const auto& estimate() const { return estimate_; }

  double evidence() const {
    return objective_.fit(explanation_, graph_, estimate_, {}) +
           objective_.log_scale_peak(explanation_);
  }

  /// Of the residuals of odometry's steps.
  std::vector<isotherm::slam::detail::Belief<Pose>> steps() const {
    std::vector<const isotherm::slam::detail::Link<Pose>*> links;
    for (const auto& step : graph_.reduced.steps) links.push_back(&step);
    std::vector<isotherm::slam::detail::Belief<Pose>> beliefs;
    for (const auto& covariance : estimate_.residual_covariances(links)) {
      beliefs.push_back({estimate_.residual(*links[beliefs.size()]), covariance});
    }
    return beliefs;
  }

 private:
  const isotherm::slam::detail::Objective<Pose>& objective_;
  isotherm::slam::detail::Explanation<Pose> explanation_;
  isotherm::slam::detail::ScaledGraph<Pose> graph_;
  isotherm::slam::detail::Estimate<Pose> estimate_;
};

}  // namespace isotherm_test
