#pragma once

#include <vector>

#include "localize/small_network.hpp"

namespace isotherm::geometry::detail {

/// What ties a point of a rigid body to its surroundings: a distance, 0 for a point that
/// is part of both.
struct Tie {
  Point own;    ///< of the body
  Point other;  ///< of the surroundings
  double distance = 0.0;
  double sigma = 1.0;
  double limit = 0.0;  ///< most that it can cost, in chi-squared

  double cost() const;  ///< min(r^2, limit)
};

/// The least cost of a mirror image of the body among its surroundings: reflections in
/// all lines (planes, in space) through d of the ends of ties (an even sample where there
/// are many), each moved as a rigid body to where its ties fit best. Infinite for fewer
/// than d ties. O(ties^(d + 1)).
double mirror_image_cost(const std::vector<Tie>& ties);

}  // namespace isotherm::geometry::detail
