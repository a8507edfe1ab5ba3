#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <type_traits>
#include <vector>

#include <nanobind/nanobind.h>

#include "arrays.hpp"
#include "isotherm/slam/graph/pose.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"

/// Poses as rows: x, y, theta in the plane, and x, y, z, qx, qy, qz, qw in space.
namespace isotherm::python {

using slam::Pose2;
using slam::Pose3;

template <class Pose>
inline constexpr std::int64_t kPoseColumns = std::is_same_v<Pose, Pose2> ? 3 : 7;

using PoseRows = nb::ndarray<nb::numpy, const double, nb::shape<-1, -1>, nb::ro>;

/// The dimension of space that the columns of `value` speak of.
/// @throws ValueError unless there are 3 or 7
int pose_dimension(nb::handle value, const char* what);

/// @throws ValueError for another number of columns, or a quaternion that is not of unit norm
template <class Pose>
std::vector<Pose> poses_from(nb::handle value, const char* what);

/// The same; a row with a NaN is not known.
template <class Pose>
std::vector<std::optional<Pose>> known_poses_from(nb::handle value, const char* what);

/// Poses every `stride` bytes, in place.
PoseRows pose_rows(const Pose2* first, std::size_t count, std::size_t stride, nb::handle owner);
PoseRows pose_rows(const Pose3* first, std::size_t count, std::size_t stride, nb::handle owner);

template <class Pose>
PoseRows pose_rows(const std::vector<Pose>& poses, nb::handle owner) {
  return pose_rows(poses.data(), poses.size(), sizeof(Pose), owner);
}

/// Poses that were just made.
template <class Pose>
PoseRows give_poses(const std::vector<Pose>& poses);

/// The same; NaN where there is none.
template <class Pose>
PoseRows give_poses(const std::vector<std::optional<Pose>>& poses);

}  // namespace isotherm::python
