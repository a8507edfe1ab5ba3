#pragma once

#include <functional>
#include <vector>

#include "localize/problem/small_network.hpp"

namespace isotherm::network::detail {

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

/// Whether a mirror image of the body among its surroundings costs less than `limit`: reflections
/// in lines (planes, in space) through d of the ends of ties (an even sample where there are
/// many), the cheapest few moved as rigid bodies to where their ties fit best. What the places of
/// the points cost is added unless the ties alone cost as much. Never for fewer than d ties.
/// O(ties) a reflection, and O(points) for those that are cheap enough.
bool has_mirror_image(const TiedBody& body, double limit, const PointsCost& points_cost = {});

}  // namespace isotherm::network::detail
