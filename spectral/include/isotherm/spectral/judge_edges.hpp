#pragma once

#include <array>
#include <concepts>
#include <vector>

#include "isotherm/base/options.hpp"
#include "isotherm/base/progress.hpp"
#include "isotherm/spectral/edge_verdicts.hpp"
#include "isotherm/spectral/threshold.hpp"
#include "isotherm/spectral/weighted_graph.hpp"

/// Which edges of a plain weighted graph do not belong there, judged by what
/// the rest of the graph says about their ends.
namespace isotherm::spectral {

enum class EdgeScore {
  heat,        ///< 1 / leave-one-out heat affinity
  resistance,  ///< leave-one-out effective resistance
  jaccard,     ///< 1 - |common neighbours| / |all neighbours|: the baseline
};

constexpr std::array<EnumName<EdgeScore>, 3> enum_names(EdgeScore) {
  return {{{EdgeScore::heat, "heat"},
           {EdgeScore::resistance, "resistance"},
           {EdgeScore::jaccard, "jaccard"}}};
}

struct JudgeEdgesOptions {
  EdgeScore method = EdgeScore::heat;
  /// Diffusion time t of exp(-tL) for heat, in units of 1 / weight; finite, > 0.
  /// About one over the weight of a typical edge looks a few hops far.
  double scale = 1.0;
  /// How the threshold is found from the scores.
  ThresholdRule threshold = ThresholdRule::mixture;
  /// Standard deviations above the mean, for the mean-sigma rule; finite.
  double konst = 1.0;
  double tolerance = 1e-9;  ///< of the heat kernel's entries, absolute, > 0
  int threads = 0;          ///< 0: all cores; results do not depend on it
  ProgressCallback progress = {};

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, JudgeEdgesOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("method", options.method, "what an edge is judged by");
  visit("scale", options.scale, "heat: diffusion time");
  visit("threshold", options.threshold, "rule that splits the scores");
  visit("konst", options.konst, "deviations above the mean, for mean-sigma");
  visit("tolerance", options.tolerance, "heat: error allowed in a heat kernel entry");
}

struct JudgeEdgesResult {
  EdgeVerdicts verdicts;  ///< one an edge, in order of id; vertices by position
  Threshold threshold;
  double seconds = 0.0;
};

/// A verdict for every edge. Edges about which the rest of the graph says
/// nothing (bridges, whose score would be infinite; for jaccard, edges without
/// any neighbour) are ambiguous, self-loops are kept.
/// @throws InvalidArgument, NumericalError, Cancelled
JudgeEdgesResult judge_edges(const WeightedGraph& graph, const JudgeEdgesOptions& options = {});

/// Jaccard index of the neighbourhoods of an edge's ends, the ends themselves
/// left out: in [0, 1]; -1 if neither has any other neighbour. Ordered ends and
/// weights do not matter, parallel edges count once. O(d_i log d_i + d_j log d_j).
double jaccard_index(const WeightedGraph& graph, Index edge);

}  // namespace isotherm::spectral
