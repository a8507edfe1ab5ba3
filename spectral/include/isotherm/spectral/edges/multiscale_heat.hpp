#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "isotherm/base/run_context.hpp"
#include "isotherm/spectral/edges/edge_verdicts.hpp"
#include "isotherm/spectral/edges/threshold.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"

/// Algorithm 1 of S. Datta et al., "SLAM Pose-graph Robustification via Multi-scale Heat-Kernel
/// Analysis", on any weighted graph.
namespace isotherm::spectral {

struct MultiscaleHeatOptions {
  /// Times t of exp(-tL), from global to local; finite, >= 0, descending; in units of 1 / weight.
  /// Empty: automatic_scales(). At t = 0 all pairs have the distance 2 and none is pruned.
  std::vector<double> scales;
  /// How a scale's threshold follows from the distances at that scale.
  ThresholdRule threshold = ThresholdRule::mean_sigma;
  /// konst of eq. 11, for the mean-sigma rule: one value for all scales or one a scale; finite.
  std::vector<double> konst = {1.0};
  /// A rule that adapts prunes nothing at a scale where its split explains less than this share
  /// of the variance of the distances; in [0, 1].
  double min_separation = 0.75;
  double tolerance = 1e-6;  ///< of every heat distance, absolute, > 0

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

/// What happened at one scale.
struct HeatRound {
  double scale = 0.0;
  double threshold = 0.0;   ///< on squared heat distance; +infinity if nothing was split
  double separation = 0.0;  ///< see Threshold
  double konst = 0.0;       ///< as used; 0 for rules without it
  std::int64_t candidates = 0;
  std::int64_t pruned = 0;
};

/// The decision about one edge.
struct MultiscaleVerdict {
  bool pruned = false;
  double score = 0.0;  ///< largest squared heat distance relative to its scale's threshold; the
                       ///< deciding scale's for a pruned edge
  std::string stage;   ///< which scale that was
};

struct MultiscaleHeat {
  std::vector<MultiscaleVerdict> verdicts;  ///< one a candidate
  std::vector<HeatRound> rounds;
  /// Squared heat distance (paper eq. 9) of each candidate at each scale, in order of
  /// rounds x candidates; NaN once it is pruned.
  std::vector<std::vector<double>> distances;
  std::int64_t unconverged = 0;  ///< distances whose certified bracket is wider than asked for
  std::int64_t imprecise = 0;    ///< distances not known to a millionth of themselves
  double widest_bracket = 0.0;
};

/// Judges the edges `candidates` (ids) by the heat distance of their ends, from large scales to
/// small ones, removing those above a scale's threshold before the next. All other edges stay.
/// One call of heat_distances() a scale.
/// @throws InvalidArgument for options out of range or an edge outside the graph; Cancelled
MultiscaleHeat multiscale_heat(const WeightedGraph& graph, std::span<const Index> candidates,
                               const MultiscaleHeatOptions& options = {},
                               const RunContext& run = {});

}  // namespace isotherm::spectral
