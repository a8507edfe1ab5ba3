#pragma once

#include <vector>

#include "isotherm/base/random.hpp"
#include "isotherm/slam/graph/pose.hpp"

namespace isotherm::slam::detail {

/// A range between a point of one rigid body and one of another.
template <class Pose>
struct BodyRange {
  typename Pose::Translation a;  ///< in the frame of the first body
  typename Pose::Translation b;  ///< in that of the second
  double distance = 0.0;
  double sigma = 0.0;
};

/// A way in which two bodies may lie.
template <class Pose>
struct JoinMode {
  Pose T_a_b;
  double cost = 0.0;  ///< -log density of the ranges
};

/// The ways in which the second body may lie that explain the ranges best, the best first: local
/// minima of the cost, of which no two are the same place. A body that `is_point` does not turn.
///
/// The error of a range is Cauchy's of the stated width, or of that which half of the errors of the
/// best mode keep within where this is larger: bodies that odometry made are not quite rigid, and
/// ranges may be false. Starts are turns of all kinds, for each the places at which as many ranges
/// meet as space has dimensions, so that mirror images are among them.
template <class Pose>
std::vector<JoinMode<Pose>> join_modes(const std::vector<BodyRange<Pose>>& ranges, bool is_point,
                                       Random& random);

/// The mirror image of a point in the line (plane, in space) through the places it was measured
/// from: ranges tell the two apart as far only as these places leave it.
template <class Pose>
Pose mirror_image(const std::vector<BodyRange<Pose>>& ranges, const Pose& point);

/// The cost of ranges of which nothing is explained: any length up to `longest`, each.
template <class Pose>
double unexplained_cost(const std::vector<BodyRange<Pose>>& ranges, double longest);

}  // namespace isotherm::slam::detail
