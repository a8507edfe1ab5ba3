#pragma once

#include <string>
#include <variant>

#include "command.hpp"
#include "isotherm/slam/evaluate/ground_truth.hpp"
#include "isotherm/slam/evaluate/trajectory_metrics.hpp"

namespace isotherm::apps {

using AnyPosePairs = std::variant<slam::PosePairs<slam::Pose2>, slam::PosePairs<slam::Pose3>>;

/// Where the two trajectories that are compared come from.
class TrajectoryInput {
 public:
  void add_to(CLI::App& verb);

  /// Estimated poses and their true ones. Says on stderr how many there are, and warns if the
  /// two do not move alike.
  /// @throws FileError, ParseError; InvalidArgument for what cannot be matched, or if fewer than
  ///   half of the poses are and --partial was not given
  AnyPosePairs read(const CommonFlags& flags) const;

 private:
  AnyPosePairs pairs_by_time(const CommonFlags& flags) const;

  std::string estimate_;
  slam::GroundTruthSource truth_;
};

}  // namespace isotherm::apps
