#pragma once

#include <array>
#include <concepts>
#include <string_view>
#include <type_traits>
#include <vector>

#include "isotherm/base/options.hpp"
#include "isotherm/base/range.hpp"
#include "isotherm/base/run_context.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/slam/prune/curve_evidence.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::slam {

/// How candidates are weighted before any spectral analysis.
enum class LoopWeights {
  chi2,      ///< 1 / (1 + chi2 / dof) with chi2 against odometry alone
  lap_line,  ///< 1 - score of the curves at its ends, see curve_evidence.hpp
  both,      ///< the product of these two
  uniform,   ///< every candidate alike
};

constexpr std::array<EnumName<LoopWeights>, 4> enum_names(LoopWeights) {
  return {{{LoopWeights::chi2, "chi2"},
           {LoopWeights::lap_line, "lap-line"},
           {LoopWeights::both, "both"},
           {LoopWeights::uniform, "uniform"}}};
}

/// Graph induction (S. Datta et al., section V-A).
struct InductionOptions {
  LoopWeights weights = LoopWeights::chi2;  ///< of the candidates
  double odometry_weight = 1.0;             ///< affinity of odometry, > 0
  double loop_weight = 1.0;                 ///< largest affinity of a candidate, > 0
  CurveEvidenceOptions curve;               ///< for lap_line and both

  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, InductionOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("init", options.weights, "weights of the loops");
  visit("odometry_weight", options.odometry_weight, "weight of odometry", left_open(0, 1e9));
  visit("loop_weight", options.loop_weight, "largest weight of a loop", left_open(0, 1e9));
  visit_fields(options.curve, visit);
}

/// A pose graph seen as a weighted graph on the same vertices.
struct InducedGraph {
  spectral::WeightedGraph graph;
  std::vector<Index> edge_constraint;  ///< per edge: position of its constraint
  std::vector<Index> constraint_edge;  ///< per constraint: its edge, or -1 if it has none
};

/// Odometry gets odometry_weight, candidates a weight in (0, loop_weight].
/// A candidate whose weight underflows to 0 has no edge. O(m log n), and the cost of
/// curve_evidence() where it is used; only that uses `run`.
/// @throws InvalidArgument, Cancelled
template <class Pose>
InducedGraph induce(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                    const InductionOptions& options = {}, const RunContext& run = {});

}  // namespace isotherm::slam
