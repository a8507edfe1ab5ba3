#pragma once

#include "prune/consensus/estimate/estimate.hpp"

namespace isotherm::slam::detail {

/// Factors on the stated covariances of translation and of rotation that are `ratio` apart and
/// leave determinants alone.
template <class Pose>
struct PartScales {
  explicit PartScales(double ratio);

  /// The same, one a coordinate.
  typename Pose::Tangent by_coordinate() const;

  double translation = 1.0;
  double rotation = 1.0;
};

/// A reduced graph with covariances other than stated, and what odometry alone adds to the
/// evidence there.
template <class Pose>
struct ScaledGraph {
  ReducedGraph<Pose> reduced;
  double log_determinant = 0.0;  ///< log |H| of odometry
  Index variables = 0;           ///< poses that are free in it
};

/// `ratio` is the factor on the covariances of rotation against those of translation: files give
/// the accuracy of both in units that are easily mistaken, for all edges alike.
template <class Pose>
ScaledGraph<Pose> scaled_graph(const PoseGraph<Pose>& graph, const EdgeRoles& roles, double ratio);

extern template struct PartScales<Pose2>;
extern template struct PartScales<Pose3>;

}  // namespace isotherm::slam::detail
