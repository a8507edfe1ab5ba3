#pragma once

#include <vector>

#include "prune/consensus/estimate/estimate.hpp"
#include "prune/consensus/odometry/step_edges.hpp"
#include "prune/consensus/odometry/turn_bias.hpp"

namespace isotherm::slam::detail {

/// Factors on the variances of each coordinate, of product 1: files give the accuracy of
/// translation and of rotation in units that are easily mistaken, and robots drive straighter than
/// they tell. And of single edges of odometry, and what all of them err by alike.
template <class Pose>
struct Shapes {
  typename Pose::Tangent odometry = Pose::Tangent::Ones();
  typename Pose::Tangent loops = Pose::Tangent::Ones();
  Slips slips;
  TurnBias<Pose> bias = TurnBias<Pose>::Zero();
  double slip_scale = 1.0;  ///< the factor on all of odometry, where edges slip: see slipped()

  bool operator==(const Shapes&) const = default;

  /// To rounding.
  bool is_about(const Shapes& other) const {
    return odometry.isApprox(other.odometry) && loops.isApprox(other.loops) &&
           slips == other.slips && bias == other.bias;
  }
};

/// Of rotation's variances against translation's, by geometric means.
template <class Pose>
double rotation_against_translation(const typename Pose::Tangent& shape);

/// A reduced graph with covariances other than stated, and what of odometry the evidence needs
/// there.
template <class Pose>
struct ScaledGraph {
  ReducedGraph<Pose> reduced;
  std::vector<ByBias<Pose>> by_bias;  ///< one a contracted step
  double log_information = 0.0;       ///< log |Omega|, summed over its steps
  Index variables = 0;                ///< poses that are free in it

  /// Whether trusted edges are steps along chains alone, of which one path joins two poses at most.
  bool is_chains() const { return reduced.steps.size() == reduced.contracted; }
};

/// `chain`: of its odometry.
template <class Pose>
ScaledGraph<Pose> scaled_graph(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                               const Chain<Pose>& chain, const Shapes<Pose>& shapes);

}  // namespace isotherm::slam::detail
