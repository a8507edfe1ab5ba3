#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam::detail {

inline constexpr std::uint32_t kNoFile = std::numeric_limits<std::uint32_t>::max();

/// The file that a constraint comes from; `ends_of_files` has the number of constraints up to
/// the end of each file but the last.
std::uint32_t file_of(Index constraint, const std::vector<std::size_t>& ends_of_files);

/// Fills `graph.robots` where there are several files and ids have no letters that say whose
/// they are: each file that has vertices of its own is a robot, unless its ids go on where
/// those of another end. `owners` has the file with the line of each vertex, or kNoFile.
template <class Pose>
void tell_robots_apart(PoseGraph<Pose>& graph, std::vector<std::uint32_t> owners,
                       const std::vector<std::size_t>& ends_of_files);

}  // namespace isotherm::slam::detail
