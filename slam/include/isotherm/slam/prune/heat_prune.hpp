#pragma once

#include <concepts>
#include <cstdint>
#include <string_view>
#include <type_traits>
#include <vector>

#include "isotherm/base/range.hpp"
#include "isotherm/base/run_context.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/slam/prune/induce.hpp"
#include "isotherm/spectral/edges/edge_verdicts.hpp"
#include "isotherm/spectral/edges/threshold.hpp"

namespace isotherm::slam {

struct PruneResult;  // prune.hpp

/// Multi-scale heat-kernel pruning (S. Datta et al., "SLAM Pose-graph
/// Robustification via Multi-scale Heat-Kernel Analysis", Algorithm 1).
struct HeatPruneOptions {
  static std::string_view method() { return "heat"; }
  static std::string_view title() { return "Heat-kernel pruning"; }

  /// Times t of exp(-tL), from global to local; finite, > 0, descending. The
  /// default is Figure 5's list. At t = 0 every pair has distance 2, so the text's
  /// "minimum is always 0" cannot be meant.
  std::vector<double> scales = {100.0, 70.0, 10.0, 5.0, 1.0, 0.1, 0.001};

  /// How a scale's threshold follows from the distances at that scale.
  spectral::ThresholdRule threshold = spectral::ThresholdRule::otsu;

  /// konst of eq. 11, for the mean-sigma rule: one value for all scales or one a
  /// scale; finite. The paper uses 0 to 4, "depending on the scale".
  std::vector<double> konst = {1.0};

  /// A rule that adapts prunes nothing at a scale whose distances do not fall
  /// into two groups: where the split explains less than this share of their
  /// variance; in [0, 1]. The best split of a uniform distribution explains 3/4.
  double min_separation = 0.75;

  InductionOptions induction;

  double tolerance = 1e-6;  ///< of every heat distance, absolute, > 0

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, HeatPruneOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("scales", options.scales, "diffusion times, descending", left_open(0, 1e12));
  visit("threshold", options.threshold, "rule that splits the distances of a scale");
  visit("konst", options.konst, "deviations above the mean, for mean-sigma; one or one a scale",
        closed(-1e6, 1e6));
  visit("min_separation", options.min_separation,
        "share of variance an adaptive split must explain", closed(0, 1));
  visit("tolerance", options.tolerance, "error allowed in a heat distance", left_open(0, 2));
  visit_fields(options.induction, visit);
}

/// What the paper states: Figure 5's scales, mean + konst * sigma, weights from
/// chi-squared (or, with weights lap_line, from descriptors as it defines them). It gives
/// konst only as "0 to 4, depending on the scale"; 1 is used at every scale here.
HeatPruneOptions datta2016();

/// What happened at one scale.
struct HeatRound {
  double scale = 0.0;
  double threshold = 0.0;   ///< on squared heat distance; +infinity if nothing was split
  double separation = 0.0;  ///< see spectral::Threshold
  double konst = 0.0;       ///< as used; 0 for rules without it
  std::int64_t candidates = 0;
  std::int64_t pruned = 0;
};

struct HeatPruneResult {
  /// score is the largest squared heat distance relative to its scale's threshold
  /// (the deciding scale's for a pruned loop); threshold is 1; stage names the scale.
  spectral::EdgeVerdicts verdicts;
  std::vector<HeatRound> rounds;
  /// Squared heat distance (paper eq. 9) of each candidate at each scale, in order of
  /// rounds x candidates; NaN once it is pruned or if it has no edge.
  std::vector<std::vector<double>> distances;
  std::vector<double> weights;   ///< induced weight per candidate; 0 without an edge
  std::int64_t unconverged = 0;  ///< distances whose certified bracket is wider than asked for
  double widest_bracket = 0.0;
};

/// Judges every candidate by the heat distance of its ends, from large scales to
/// small ones, removing the worst before each next scale. Candidates whose induced
/// weight underflows are pruned at once (stage "induction").
/// @throws InvalidArgument, Cancelled
template <class Pose>
HeatPruneResult heat_prune(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                           const HeatPruneOptions& options = {}, const RunContext& run = {});

namespace detail {

/// The door of the method's room, through which prune() comes.
template <class Pose>
PruneResult prune_by(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const HeatPruneOptions& options, const RunContext& run);

}  // namespace detail

}  // namespace isotherm::slam
