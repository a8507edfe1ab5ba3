#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <unordered_map>
#include <vector>

#include "command.hpp"
#include "isotherm/slam/evaluate/ground_truth.hpp"
#include "isotherm/slam/evaluate/trajectory_metrics.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::apps {

/// How far estimates of a graph that comes in are from the truth.
template <class Pose>
class ErrorTrack {
 public:
  /// `whole` is the graph as it is in the end, by which the truth is matched.
  /// @throws as read_truth()
  ErrorTrack(const slam::PoseGraph<Pose>& whole, const slam::GroundTruthSource& source,
             const CommonFlags& flags);

  /// Root of the mean squared error of positions, aligned, of the poses that have `come` in edges;
  /// none where these leave open how they are turned.
  std::optional<double> ate(const slam::PoseGraph<Pose>& now, const std::set<slam::VertexId>& come);

  /// The mean of all that were asked for (iATE); none where there was none.
  std::optional<double> mean() const;

 private:
  std::unordered_map<slam::VertexId, Pose> truth_;
  double sum_ = 0.0;
  std::int64_t count_ = 0;
};

}  // namespace isotherm::apps
