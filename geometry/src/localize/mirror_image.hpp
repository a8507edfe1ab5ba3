#pragma once

#include <functional>
#include <limits>
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
  Limits limits;  ///< most that it can cost

  double cost() const;   ///< min(r^2, limit)
  double limit() const;  ///< the limit that applies
};

/// A rigid body: what ties it, and more points of it.
struct TiedBody {
  std::vector<Tie> ties;
  std::vector<Point> points = {};
};

/// What it costs, in chi-squared, that the points of a body are at these places.
using PointsCost = std::function<double(const std::vector<Point>&)>;

/// The least cost of a mirror image of the body among its surroundings: reflections in
/// all lines (planes, in space) through d of the ends of ties (an even sample where there
/// are many), the cheapest few moved as rigid bodies to where their ties fit best. What the
/// places of the points cost is added unless the ties alone cost `enough`. Infinite for fewer
/// than d ties. O(ties + points) a reflection.
double mirror_image_cost(const TiedBody& body, const PointsCost& points_cost = {},
                         double enough = std::numeric_limits<double>::infinity());

}  // namespace isotherm::geometry::detail
