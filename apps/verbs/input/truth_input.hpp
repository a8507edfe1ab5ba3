#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "command.hpp"
#include "isotherm/slam/evaluate/ground_truth.hpp"
#include "isotherm/slam/evaluate/trajectory_metrics.hpp"

namespace isotherm::apps {

/// The flags that say how the true poses are to be taken: --axes and --partial.
void add_truth_flags(CLI::App& verb, slam::GroundTruthSource& truth);

/// The true poses of the vertices. Says on stderr how many there are, and warns if they do not
/// move as odometry does.
/// @throws as slam::read_ground_truth()
template <class Pose>
std::vector<std::optional<Pose>> read_truth(const slam::PoseGraph<Pose>& graph,
                                            const slam::GroundTruthSource& source,
                                            const CommonFlags& flags);

/// Warns if the two move differently; `other` is what the truth is compared with.
template <class Pose>
void warn_of_motion(const slam::PosePairs<Pose>& pairs, const std::string& other,
                    const CommonFlags& flags);

}  // namespace isotherm::apps
