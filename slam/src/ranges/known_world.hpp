#pragma once

#include <vector>

#include "isotherm/slam/graph/range_graph.hpp"
#include "ranges/range_equations.hpp"

namespace isotherm::slam::detail {

/// A graph in which what is known of the world is measurements like all others: priors are steps
/// from a node of its own, the world, which is held, as anchors are.
template <class Pose>
struct KnownWorld {
  RangeGraph<Pose> graph;     ///< with the world, if there are priors, as the last node
  std::vector<bool> held;     ///< one a node
  std::vector<double> sigma;  ///< one a range, > 0, as stated or a guess where nothing is
  double longest = 1.0;       ///< metres: of the ranges
  double typical_sigma = 1.0;

  bool anchored() const;
};

/// @throws InvalidArgument for what `locate` throws it
template <class Pose>
KnownWorld<Pose> know_world(const RangeGraph<Pose>& graph, const std::vector<Index>& anchors);

/// Which nodes are in one frame, and which are in any.
struct Bodies {
  std::vector<Index> parent;  ///< of disjoint sets
  std::vector<bool> active;   ///< has a pose in the frame of its body

  Index of(Index node);
  void join(Index a, Index b);
};

/// What is estimated of bodies with ranges within each of them.
template <class Pose>
RangeProblem<Pose> problem_of(const KnownWorld<Pose>& world, Bodies& bodies);

}  // namespace isotherm::slam::detail
