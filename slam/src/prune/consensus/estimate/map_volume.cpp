#include "prune/consensus/estimate/map_volume.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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
constexpr double kLeastSide = 1e-3;

}  // namespace

template <class Pose>
MapVolume<Pose>::MapVolume(const std::vector<Pose>& poses) {
  using Translation = typename Pose::Translation;
  const auto count = static_cast<double>(std::max<std::size_t>(poses.size(), 1));
  Translation center = Translation::Zero();
  for (const Pose& pose : poses) center += pose.translation() / count;
  double variance = 0.0;
  for (const Pose& pose : poses) {
    variance += (pose.translation() - center).squaredNorm() / (count * Pose::kDim);
  }
  const double side = 2.0 * std::max(std::sqrt(12.0 * variance), kLeastSide);
  const int turns = Pose::kDof - Pose::kDim;
  const double angle = std::pow(rotation_volume<Pose>(), 1.0 / turns);
  variance_.template head<Pose::kDim>().setConstant(side * side / (2.0 * kPi));
  variance_.tail(turns).setConstant(angle * angle / (2.0 * kPi));
}

template class MapVolume<Pose2>;
template class MapVolume<Pose3>;

}  // namespace isotherm::slam::detail
