#include <algorithm>
#include <cmath>
#include <numbers>

#include "isotherm/base/error.hpp"
#include "simulate/measure_path.hpp"

namespace isotherm::slam {
namespace {

// The spiral theta = pi s, phi = 2 pi laps s, s in (0, 1), on a sphere of radius R
// is close to 4 R laps long, and its turns are pi R / laps apart.
struct Spiral {
  double laps = 1.0;
  double radius = 1.0;

  Pose3 at(double s) const {
    const double theta = std::numbers::pi * s;
    const double phi = 2.0 * std::numbers::pi * laps * s;
    const Eigen::Vector3d up(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                             std::cos(theta));
    const Eigen::Vector3d south(std::cos(theta) * std::cos(phi), std::cos(theta) * std::sin(phi),
                                -std::sin(theta));
    const Eigen::Vector3d east(-std::sin(phi), std::cos(phi), 0.0);
    const Eigen::Vector3d forward = (south + 2.0 * laps * std::sin(theta) * east).normalized();
    Eigen::Matrix3d rotation;
    rotation << forward, up.cross(forward), up;
    return {radius * up, Eigen::Quaterniond(rotation).normalized()};
  }
};

Spiral spiral(const SphereOptions& options) {
  const auto length = static_cast<double>(options.poses);
  const double laps = options.laps > 0
                          ? static_cast<double>(options.laps)
                          : std::max(1.0, std::round(std::sqrt(std::numbers::pi * length) / 2.0));
  return {.laps = laps, .radius = length / (4.0 * laps)};
}

}  // namespace

void SphereOptions::validate() const { require_fields_in_range(*this); }

Simulation<Pose3> simulate_sphere(const SphereOptions& options) {
  options.validate();
  const Spiral line = spiral(options);
  std::vector<Pose3> path;
  path.reserve(static_cast<std::size_t>(options.poses));
  for (std::int64_t k = 0; k < options.poses; ++k) {
    path.push_back(line.at((static_cast<double>(k) + 0.5) / static_cast<double>(options.poses)));
  }
  Random random(options.seed);
  return detail::measure_path(std::move(path), options.measurements, random);
}

}  // namespace isotherm::slam
