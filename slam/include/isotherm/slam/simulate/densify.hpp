#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>

#include "isotherm/base/range.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam {

/// How loops are replicated in their neighbourhood.
struct DensifyOptions {
  /// Copies of a loop on either side; in [1, 1000]. S. Datta et al. do not say how many they made.
  std::int64_t copies = 4;

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, DensifyOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("copies", options.copies, "copies of a loop on either side", closed(1, 1000));
}

/// The graph with every loop (i, j) replicated between (i + k, j + k), k = ±1 ... ±copies, at the
/// end of the constraints (S. Datta et al., section VI-A: methods that go by the graph's topology
/// need loops that back each other). A copy's transform is the loop's, carried along odometry at
/// both ends; its information is the loop's, without what odometry adds. There is no copy where
/// odometry does not reach, between a vertex and itself, or where a constraint joins the two
/// already. False loops are replicated like true ones. O(loops copies log n).
/// @throws InvalidArgument
template <class Pose>
PoseGraph<Pose> densify(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                        const DensifyOptions& options = {});

}  // namespace isotherm::slam
