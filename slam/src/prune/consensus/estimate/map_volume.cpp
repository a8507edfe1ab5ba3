#include "prune/consensus/estimate/map_volume.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "prune/consensus/constants.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr double kPi = std::numbers::pi;

// The volume of all rotations in units of rotation vectors: 2 pi in the plane,
// 8 pi^2 in space (twice the ball's Haar density 1/(8 pi^2) at the identity).
template <class Pose>
constexpr double rotation_volume() {
  return Pose::kDim == 2 ? 2.0 * kPi : 8.0 * kPi * kPi;
}

// A map of one point has no size; any positive one serves.
constexpr double kLeastExtent = 1e-3;

}  // namespace

template <class Pose>
MapVolume<Pose>::MapVolume(const std::vector<Pose>& poses) {
  using Translation = typename Pose::Translation;
  Translation low = Translation::Constant(std::numeric_limits<double>::infinity());
  Translation high = -low;
  for (const Pose& pose : poses) {
    low = low.cwiseMin(pose.translation());
    high = high.cwiseMax(pose.translation());
  }
  Translation extent = Translation::Zero();
  if (!poses.empty()) extent = high - low;
  const double least = std::max(kLeastAspect * extent.maxCoeff(), kLeastExtent);
  extent = (2.0 * extent).cwiseMax(least);

  const double side = std::pow(extent.prod(), 1.0 / Pose::kDim);
  const int turns = Pose::kDof - Pose::kDim;
  const double angle = std::pow(rotation_volume<Pose>(), 1.0 / turns);
  variance_.template head<Pose::kDim>().setConstant(side * side / (2.0 * kPi));
  variance_.tail(turns).setConstant(angle * angle / (2.0 * kPi));
}

template class MapVolume<Pose2>;
template class MapVolume<Pose3>;

}  // namespace isotherm::slam::detail
