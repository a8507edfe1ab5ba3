#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "isotherm/base/options.hpp"
#include "isotherm/base/range.hpp"
#include "isotherm/base/run_context.hpp"
#include "isotherm/spectral/edges/edge_verdicts.hpp"
#include "isotherm/spectral/edges/threshold.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"

/// Which edges of a plain weighted graph do not belong there, judged by what
/// the rest of the graph says about their ends.
namespace isotherm::spectral {

enum class EdgeScore {
  heat,               ///< annealed leave-one-out heat affinity, see judge_edges()
  heat_multiscale,    ///< heat distance, scale by scale: multiscale_heat()
  affinity,           ///< 1 / leave-one-out heat affinity at one scale, certified
  resistance,         ///< leave-one-out effective resistance beyond that of the ends' own edges
  jaccard,            ///< 1 - |common neighbours| / |all neighbours|: the baseline
  common_neighbours,  ///< 1 / (1 + |common neighbours|)
  rank,               ///< how many vertices lie nearer, where positions are known
};

constexpr std::array<EnumName<EdgeScore>, 7> enum_names(EdgeScore) {
  return {{{EdgeScore::heat, "heat"},
           {EdgeScore::heat_multiscale, "heat-multiscale"},
           {EdgeScore::affinity, "affinity"},
           {EdgeScore::resistance, "resistance"},
           {EdgeScore::jaccard, "jaccard"},
           {EdgeScore::common_neighbours, "common-neighbours"},
           {EdgeScore::rank, "rank"}}};
}

/// Which pairs of vertices false edges are taken to resemble.
enum class ControlGroup {
  anywhere,  ///< any two vertices
  near,      ///< vertices a few steps apart, but further than a neighbour's neighbour
};

constexpr std::array<EnumName<ControlGroup>, 2> enum_names(ControlGroup) {
  return {{{ControlGroup::anywhere, "anywhere"}, {ControlGroup::near, "near"}}};
}

/// Where scores part true edges from false ones.
enum class EdgeThreshold {
  control,     ///< where edges of that score are false by all that heat measures of them
  mean_sigma,  ///< the others as ThresholdRule has them
  otsu,
  mixture,
  gap,
};

constexpr std::array<EnumName<EdgeThreshold>, 5> enum_names(EdgeThreshold) {
  return {{{EdgeThreshold::control, "control"},
           {EdgeThreshold::mean_sigma, "mean-sigma"},
           {EdgeThreshold::otsu, "otsu"},
           {EdgeThreshold::mixture, "mixture"},
           {EdgeThreshold::gap, "gap"}}};
}

/// Standard deviations above the mean where the mean-sigma rule is asked for without a konst.
inline constexpr double kDefaultKonst = 3.0;

struct JudgeEdgesOptions {
  EdgeScore method = EdgeScore::heat;
  /// Heat: how often the edges are judged, each time in the graph weighted by the
  /// judgement before and at twice the scale; in [1, 10].
  int rounds = 3;
  /// The pairs that edges are compared with. `near` finds short circuits that run
  /// side by side, at the price of a few more true edges.
  ControlGroup control = ControlGroup::anywhere;
  /// Heat: an edge is pruned where it is less likely than this to be a true one, but no more edges
  /// are than there are false ones by the estimate; in (0, 1). Less prunes less; with 0.7 precision
  /// and recall are about equal on Swiss rolls.
  double chance = 0.7;
  /// Heat: weigh, too, where the vertices might be, in graphs of at most 1,400 of them. Takes three
  /// to eight times as long and halves the errors where vertices have places in space.
  bool places = true;
  /// Affinity: diffusion time t of exp(-tL), in units of 1 / weight; finite, > 0.
  /// About one over the weight of a typical edge looks a few hops far.
  double scale = 1.0;
  /// How the threshold is found from the scores, for all methods but heat, which always goes by the
  /// control group.
  EdgeThreshold threshold = EdgeThreshold::control;
  /// Standard deviations above the mean, for the mean-sigma rule: one value, or for heat-multiscale
  /// one a scale, which uses that rule if any is named; finite. None: kDefaultKonst. The paper has
  /// 0 to 4; 1 takes about one edge in six at every scale, whether any is false or not.
  std::vector<double> konst;
  /// Heat-multiscale: diffusion times, descending, in units of 1 / weight; finite, >= 0. Empty:
  /// automatic_scales().
  std::vector<double> scales;
  double tolerance = 1e-9;  ///< affinity, heat-multiscale: of heat, absolute, > 0
  /// Heat-multiscale: edges, by id, that are known to be true. They stay and count in no threshold.
  std::vector<Index> trusted;

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, JudgeEdgesOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("method", options.method, "what an edge is judged by");
  visit("rounds", options.rounds, "heat: how often edges are judged", closed(1, 10));
  visit("control", options.control, "pairs that false edges resemble");
  visit("chance", options.chance, "heat: prune what is less likely true", open(0, 1));
  visit("places", options.places, "heat: weigh where vertices of small graphs might be");
  visit("scale", options.scale, "affinity: diffusion time", left_open(0, 1e12));
  visit("threshold", options.threshold, "but for heat: what scores are compared with");
  visit("konst", options.konst,
        "deviations above the mean, for mean-sigma; heat-multiscale: one or one a scale",
        or_none(closed(-1e6, 1e6)));
  visit("scales", options.scales,
        "heat-multiscale: diffusion times, descending; none: by the graph",
        or_none(closed(0, 1e12)));
  visit("tolerance", options.tolerance, "affinity, heat-multiscale: error allowed in heat",
        left_open(0, 1));
}

struct JudgeEdgesResult {
  EdgeVerdicts verdicts;  ///< one an edge, in order of id; vertices by position
  Threshold threshold;    ///< by control, its separation is the mean of |2 p - 1|
  /// What the scores cannot be trusted for: resistances without a proven bound, say.
  std::vector<std::string> warnings;
  double seconds = 0.0;
};

/// A verdict for every edge. Bridges are ambiguous by every method, score 0 and stage "bridge":
/// the graph itself says which they are, whatever the weights. So are edges about which nothing
/// is known (stage "no evidence"). Self-loops are kept. Parallel edges are judged as one.
///
/// Heat prunes an edge that is less likely than `chance` to be a true one, but no more of them than
/// are false by its own estimate. The thresholds of the other methods are where the highest F is to
/// be expected by the probabilities that heat gives (docs/concepts/edge-affinity.md); it costs as
/// much as heat does. Any other EdgeThreshold goes by the scores alone.
///
/// Heat finds the heat affinity of an edge's ends in the normalised graph without the edge, from
/// walks of a few steps, and takes as the probability p that the edge is a true one its local false
/// discovery rate against pairs of vertices that no edge joins, the control group; edges are then
/// judged again in the graph weighted by p. Last, affinity, steps between the ends, common
/// neighbours and both ends' numbers of neighbours are weighed by a regression of random pairs
/// against edges, and where the graph is nearly planar and has up to some ten thousand edges what
/// each edge crosses is, too. The score is the log odds of false against true, the least being 0.
/// All is done a second time with the most suspicious edges left out of a round; the answer of the
/// higher evidence counts. With `places`, so does what places of the vertices say, sampled in two
/// and in three dimensions such that what is near is joined and nothing else. A chain of edges
/// through vertices of degree two is judged as one, of which one at most is taken to be false. Time
/// n times the edges within a few steps of a vertex; the other methods' costs are those of their
/// functions.
///
/// Rank is for vertices of known `positions` (dimension x vertices), which the other methods do not
/// use. It scores an edge by how many vertices are nearer to one of its ends than the other end is,
/// counted from the end that has fewer of them: where vertices are sparse true edges are long, but
/// do not reach past many. Chains are judged like other edges. O(edges sqrt n) in the plane.
///
/// Heat-multiscale is multiscale_heat() of all edges but bridges, self-loops and trusted ones; its
/// scores are relative to the thresholds, and its own threshold is 1.
///
/// The seed is that of the random pairs.
/// @throws InvalidArgument, also for rank unless there is a finite position for each vertex and for
/// a trusted edge outside the graph;
///   NumericalError, Cancelled
JudgeEdgesResult judge_edges(const WeightedGraph& graph, const JudgeEdgesOptions& options = {},
                             const Eigen::MatrixXd& positions = {}, const RunContext& run = {});

/// The graph without the edges that are pruned and, unless `keep_ambiguous`, without those that
/// are ambiguous. @throws InvalidArgument unless there is one verdict an edge, in order of id
WeightedGraph apply_verdicts(const WeightedGraph& graph, const EdgeVerdicts& verdicts,
                             bool keep_ambiguous = true);

/// Jaccard index of the neighbourhoods of an edge's ends, the ends themselves
/// left out: in [0, 1]; -1 if neither has any other neighbour. Ordered ends and
/// weights do not matter, parallel edges count once. O(d_i log d_i + d_j log d_j).
double jaccard_index(const WeightedGraph& graph, Index edge);

}  // namespace isotherm::spectral
