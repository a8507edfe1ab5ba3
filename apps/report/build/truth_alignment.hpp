#pragma once

#include <optional>
#include <vector>

#include "isotherm/slam/evaluate/trajectory_metrics.hpp"
#include "report/report.hpp"

namespace isotherm::apps {

/// True poses compared with estimated ones, as a report shows it.
struct TruthComparison {
  slam::ErrorStatistics statistics;  ///< metres
  std::vector<float> errors;         ///< a pose; NaN without truth
  std::vector<float> truth;          ///< poses x dimension, moved onto the estimate
};

/// Aligns by least squares (slam::Alignment::se), or, where that leaves the rotation
/// open, by the first pose. Nothing if no pose has a true one.
template <class Pose>
std::optional<TruthComparison> compare_with_truth(const std::vector<Pose>& estimate,
                                                  const std::vector<std::optional<Pose>>& truth,
                                                  const std::vector<double>& origin);

}  // namespace isotherm::apps
