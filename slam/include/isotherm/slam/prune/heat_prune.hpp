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
#include "isotherm/spectral/edges/multiscale_heat.hpp"
#include "isotherm/spectral/edges/threshold.hpp"

namespace isotherm::slam {

struct PruneResult;  // prune.hpp

/// Multi-scale heat-kernel pruning (S. Datta et al., "SLAM Pose-graph
/// Robustification via Multi-scale Heat-Kernel Analysis", Algorithm 1).
struct HeatPruneOptions {
  static std::string_view method() { return "heat"; }
  static std::string_view title() { return "Heat-kernel pruning"; }

  /// Times t of exp(-tL), from global to local; finite, >= 0, descending. The default is
  /// Figure 5's list; empty means spectral::automatic_scales() of the induced graph (section
  /// V-D). At t = 0 every pair has distance 2 and none is pruned.
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
  visit("scales", options.scales, "diffusion times, descending; none: by the graph",
        or_none(closed(0, 1e12)));
  visit("threshold", options.threshold, "rule that splits the distances of a scale");
  visit("konst", options.konst,
        "k of the mean-sigma rule, which prunes above mean + k deviations; one for all scales, "
        "or one per scale",
        closed(-1e6, 1e6));
  visit("min_separation", options.min_separation,
        "share of variance an adaptive split must explain", closed(0, 1));
  visit("tolerance", options.tolerance, "error allowed in a heat distance", left_open(0, 2));
  visit_fields(options.induction, visit);
}

/// What the paper states: scales from where the kernel saturates down, evenly spaced in their
/// logarithms (section V-D), mean + konst * sigma (eq. 11), loops weighted below odometry (V-A), by
/// chi-squared (or, with weights lap_line, by descriptors as it defines them). It leaves room in
/// the number of scales, seven as in Figure 5; in the smallest, 0.001 as there, since at its 0
/// nothing can be told; in the weights, a tenth of odometry's at most; and in konst, "0 to 4,
/// depending on the scale": 1 at every scale.
HeatPruneOptions datta2016();

using spectral::HeatRound;

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

/// What heat_prune() asks of a plain graph: which of these edges are false? For who has another
/// engine to answer it than multiscale_heat(), as several machines (docs/distributed.md).
struct HeatQuestion {
  InducedGraph induced;
  std::vector<std::size_t> candidates;  ///< positions in EdgeRoles::candidates that have an edge
  std::vector<Index> edges;             ///< theirs, in the induced graph
};

/// What of the options is for multiscale_heat().
spectral::MultiscaleHeatOptions multiscale_options(const HeatPruneOptions& options);

/// @throws InvalidArgument, Cancelled
template <class Pose>
HeatQuestion heat_question(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                           const HeatPruneOptions& options = {}, const RunContext& run = {});

/// The decisions about all candidates, given what was found for those of `question`. No distances
/// in the answer: none in the result.
template <class Pose>
HeatPruneResult heat_verdicts(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                              const HeatQuestion& question, spectral::MultiscaleHeat answer);

/// As prune() gives it, but for its seconds.
PruneResult prune_result(HeatPruneResult found);

namespace detail {

/// The door of the method's room, through which prune() comes.
template <class Pose>
PruneResult prune_by(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                     const HeatPruneOptions& options, const RunContext& run);

}  // namespace detail

}  // namespace isotherm::slam
