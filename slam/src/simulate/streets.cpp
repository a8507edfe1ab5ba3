#include <algorithm>
#include <cmath>

#include "isotherm/base/error.hpp"
#include "simulate/lattice_walk.hpp"
#include "simulate/measure_path.hpp"

namespace isotherm::slam {
namespace {

// Half the width of a city whose streets would fill `side` metres: whole blocks,
// at least one.
std::int64_t half_width(double side, std::int64_t block) {
  const auto blocks = static_cast<std::int64_t>(side / (2.0 * static_cast<double>(block)));
  return block * std::max<std::int64_t>(1, blocks);
}

Pose2 planar(const detail::LatticeStop& stop) {
  const Eigen::Vector3d heading = stop.frame.col(0).cast<double>();
  return {stop.cell.head<2>().cast<double>(), std::atan2(heading.y(), heading.x())};
}

Pose3 spatial(const detail::LatticeStop& stop) {
  const Eigen::Matrix3d rotation = stop.frame.cast<double>();
  return {stop.cell.cast<double>(), Eigen::Quaterniond(rotation).normalized()};
}

}  // namespace

void CityOptions::validate() const { require_fields_in_range(*this); }

void Grid3dOptions::validate() const { require_fields_in_range(*this); }

// Both cities are as large as makes their streets about twice as long as the path,
// so that places are met again without the walk staying in one corner: a square of
// side s has 2 s^2 / block metres of streets, a cube 3 s^3 / block^2.

Simulation<Pose2> simulate_city(const CityOptions& options) {
  options.validate();
  Random random(options.seed);
  const double side = std::sqrt(static_cast<double>(options.poses * options.block));
  const auto walk = detail::lattice_walk(
      options.poses, {.block = options.block, .limit = half_width(side, options.block)}, random);
  std::vector<Pose2> path;
  path.reserve(walk.size());
  for (const auto& stop : walk) path.push_back(planar(stop));
  return detail::measure_path(std::move(path), options.measurements, random);
}

Simulation<Pose3> simulate_grid3d(const Grid3dOptions& options) {
  options.validate();
  Random random(options.seed);
  const auto block = static_cast<double>(options.block);
  const double side = std::cbrt(2.0 / 3.0 * static_cast<double>(options.poses) * block * block);
  const auto walk = detail::lattice_walk(
      options.poses,
      {.block = options.block, .limit = half_width(side, options.block), .up_and_down = true},
      random);
  std::vector<Pose3> path;
  path.reserve(walk.size());
  for (const auto& stop : walk) path.push_back(spatial(stop));
  return detail::measure_path(std::move(path), options.measurements, random);
}

}  // namespace isotherm::slam
