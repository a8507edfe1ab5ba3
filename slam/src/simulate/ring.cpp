#include <cmath>
#include <numbers>

#include "isotherm/base/error.hpp"
#include "simulate/measure_path.hpp"

namespace isotherm::slam {

void RingOptions::validate() const { require_fields_in_range(*this); }

Simulation<Pose2> simulate_ring(const RingOptions& options) {
  options.validate();
  const double step = 2.0 * std::numbers::pi * static_cast<double>(options.laps) /
                      static_cast<double>(options.poses);  // radians, and metres by the radius
  const double radius = 1.0 / step;
  std::vector<Pose2> path;
  path.reserve(static_cast<std::size_t>(options.poses));
  for (std::int64_t k = 0; k < options.poses; ++k) {
    const double angle = step * static_cast<double>(k);
    path.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                      wrap_angle(angle + 0.5 * std::numbers::pi));
  }
  Random random(options.seed);
  return detail::measure_path(std::move(path), options.measurements, random);
}

}  // namespace isotherm::slam
