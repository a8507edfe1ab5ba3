#pragma once

#include <vector>

#include "isotherm/slam/graph/pose.hpp"

namespace isotherm::slam::detail {

/// "Anywhere": the distribution that a false loop's residual is taken to have.
///
/// A normal density whose covariance M is isotropic in translation and in
/// rotation, with |2 pi M|^(1/2) the volume that relative poses can take on the
/// map: twice the side of the square or cube in which positions spread as far, in
/// every direction (false loops leave the plane of a flat map), and every rotation.
template <class Pose>
class MapVolume {
 public:
  using Matrix = typename Pose::Matrix;
  using Tangent = typename Pose::Tangent;

  explicit MapVolume(const std::vector<Pose>& poses);

  const Tangent& variance() const noexcept { return variance_; }

 private:
  Tangent variance_;
};

}  // namespace isotherm::slam::detail
