#include "isotherm/spectral/edges/judge_edges.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "edges/annealed_heat.hpp"
#include "edges/control_pairs.hpp"
#include "edges/pair_ranks.hpp"
#include "edges/two_groups.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/spectral/heat/heat_affinity.hpp"
#include "isotherm/spectral/resistance/effective_resistance.hpp"

namespace isotherm::spectral {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::infinity();

// Ascending, each once, without the vertex itself.
std::vector<Index> sorted_neighbours(const WeightedGraph& graph, Index vertex) {
  std::vector<Index> found;
  for (const auto& neighbour : graph.neighbours(vertex)) {
    if (neighbour.vertex != vertex) found.push_back(neighbour.vertex);
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

struct NeighbourCounts {
  std::size_t common = 0;
  std::size_t all = 0;
};

// Of the two ends of an edge, which do not count themselves. The shorter list is looked up
// in the longer one, so that a hub costs little more than its neighbours.
NeighbourCounts count_neighbours(const std::vector<Index>& first, const std::vector<Index>& second,
                                 bool self_loop) {
  const bool swapped = second.size() < first.size();
  const auto& shorter = swapped ? second : first;
  const auto& longer = swapped ? first : second;
  const auto common = static_cast<std::size_t>(std::ranges::count_if(
      shorter, [&](Index vertex) { return std::ranges::binary_search(longer, vertex); }));
  const std::size_t ends = self_loop ? 0 : 2;  // each is in the other's list
  return {common, first.size() + second.size() - ends - common};
}

std::vector<NeighbourCounts> count_all_neighbours(const WeightedGraph& graph) {
  std::vector<std::vector<Index>> neighbours;
  for (Index v = 0; v < graph.vertex_count(); ++v) {
    neighbours.push_back(sorted_neighbours(graph, v));
  }
  std::vector<NeighbourCounts> counts;
  for (const auto& [from, to, weight] : graph.edges()) {
    counts.push_back(count_neighbours(neighbours[from], neighbours[to], from == to));
  }
  return counts;
}

double jaccard_index(const NeighbourCounts& counts) {
  if (counts.all == 0) return -1.0;
  return static_cast<double>(counts.common) / static_cast<double>(counts.all);
}

std::vector<double> affinity_scores(const WeightedGraph& graph, const JudgeEdgesOptions& options,
                                    const RunContext& run) {
  // Affinities that the tolerance cannot tell from 0 speak of a bridge.
  constexpr double kNoise = 4.0;
  std::vector<Index> edges(graph.edges().size());
  std::iota(edges.begin(), edges.end(), 0);
  const auto affinities = leave_one_out_affinities(
      graph, edges, std::vector<double>{options.scale},
      {.tolerance = options.tolerance, .threads = run.threads, .progress = run.progress});
  std::vector<double> scores;
  for (const auto& affinity : affinities.values) {
    const bool measurable = affinity.value > kNoise * affinity.width();
    scores.push_back(measurable ? 1.0 / affinity.value : kUnknown);
  }
  return scores;
}

std::vector<double> resistance_scores(const WeightedGraph& graph) {
  auto scores = edge_resistances(graph).values;
  for (std::size_t e = 0; e < scores.size(); ++e) {
    scores[e] = leave_one_out_resistance(scores[e], graph.edges()[e].weight);
  }
  return scores;
}

std::vector<double> jaccard_scores(const WeightedGraph& graph) {
  std::vector<double> scores;
  for (const auto& counts : count_all_neighbours(graph)) {
    const double index = jaccard_index(counts);
    scores.push_back(index < 0.0 ? kUnknown : 1.0 - index);
  }
  return scores;
}

std::vector<double> common_neighbour_scores(const WeightedGraph& graph) {
  std::vector<double> scores;
  for (const auto& [common, all] : count_all_neighbours(graph)) {
    scores.push_back(all == 0 ? kUnknown : 1.0 / (1.0 + static_cast<double>(common)));
  }
  return scores;
}

std::vector<double> scores_of(const WeightedGraph& graph, const JudgeEdgesOptions& options,
                              const RunContext& run) {
  switch (options.method) {
    case EdgeScore::heat:
    case EdgeScore::rank:
      break;
    case EdgeScore::affinity:
      return affinity_scores(graph, options, run);
    case EdgeScore::resistance:
      return resistance_scores(graph);
    case EdgeScore::jaccard:
      return jaccard_scores(graph);
    case EdgeScore::common_neighbours:
      return common_neighbour_scores(graph);
  }
  throw InvalidArgument("method", "is not a method");
}

EdgeVerdict judge(const WeightedEdge& edge, Index id, double score, double threshold,
                  std::string_view method) {
  EdgeVerdict verdict;
  verdict.edge = id;
  verdict.from = static_cast<std::uint64_t>(edge.from);
  verdict.to = static_cast<std::uint64_t>(edge.to);
  verdict.score = score;
  verdict.threshold = threshold;
  verdict.stage = method;
  if (edge.from == edge.to) {
    verdict.score = 0.0;
    verdict.stage = "self-loop";
  } else if (score == kUnknown) {
    verdict.verdict = Verdict::ambiguous;
    verdict.stage = "bridge";
  } else if (score > threshold) {
    verdict.verdict = Verdict::prune;
  }
  return verdict;
}

JudgeEdgesResult judge_all(const WeightedGraph& graph, const std::vector<double>& scores,
                           const Threshold& threshold, std::string_view stage) {
  JudgeEdgesResult result;
  result.threshold = threshold;
  for (Index e = 0; e < graph.edge_count(); ++e) {
    result.verdicts.push_back(judge(graph.edge(e), e, scores[e], threshold.value, stage));
  }
  return result;
}

JudgeEdgesResult judge_by_threshold(const WeightedGraph& graph, const JudgeEdgesOptions& options,
                                    const RunContext& run) {
  const auto scores = scores_of(graph, options, run);
  std::vector<double> known;
  for (std::size_t e = 0; e < scores.size(); ++e) {
    const auto& edge = graph.edges()[e];
    if (scores[e] != kUnknown && edge.from != edge.to) known.push_back(scores[e]);
  }
  const auto threshold = find_threshold(known, {.rule = options.threshold, .konst = options.konst});
  return judge_all(graph, scores, threshold, enum_name(options.method));
}

/// A threshold with the mean of |2 p - 1|: how decided the probabilities of the edges are.
Threshold decided_threshold(double value, const std::vector<double>& truth) {
  Threshold threshold{value, 0.0, !std::isfinite(value)};
  for (const double p : truth) threshold.separation += std::abs(2.0 * p - 1.0);
  if (!truth.empty()) threshold.separation /= static_cast<double>(truth.size());
  return threshold;
}

JudgeEdgesResult judge_by_heat(const WeightedGraph& graph, const JudgeEdgesOptions& options,
                               const RunContext& run) {
  auto heat = detail::anneal_heat(graph, {.rounds = options.rounds,
                                          .chance = options.chance,
                                          .control = options.control,
                                          .seed = run.seed,
                                          .threads = run.threads,
                                          .progress = run.progress});
  std::vector<double> judged;
  for (std::size_t e = 0; e < heat.scores.size(); ++e) {
    const auto& edge = graph.edges()[e];
    if (heat.bridge[e]) heat.scores[e] = kUnknown;
    if (!heat.bridge[e] && edge.from != edge.to) judged.push_back(heat.truth[e]);
  }
  const std::string stage = "heat scale " + format_number(heat.scale) + " steps " +
                            std::to_string(heat.horizon) + (heat.in_plane ? " crossings" : "");
  return judge_all(graph, heat.scores, decided_threshold(heat.threshold, judged), stage);
}

void check_positions(const WeightedGraph& graph, const Eigen::MatrixXd& positions) {
  if (positions.cols() != graph.vertex_count() || positions.rows() == 0) {
    throw InvalidArgument("positions", "method rank needs one for each vertex");
  }
  if (!positions.allFinite()) throw InvalidArgument("positions", "must be finite");
}

JudgeEdgesResult judge_by_rank(const WeightedGraph& graph, const JudgeEdgesOptions& options,
                               const Eigen::MatrixXd& positions, const RunContext& run) {
  check_positions(graph, positions);
  const auto ranks_of = [&](const std::vector<VertexPair>& pairs) {
    return detail::pair_ranks(positions, pairs, run.threads, run.progress);
  };
  const auto scores = ranks_of(edge_pairs(graph));
  const auto nulls = ranks_of(detail::control_pairs(graph, options.control, run.seed));
  const auto groups = detail::separate_groups(scores, nulls);
  const double threshold = detail::rejection_threshold(scores, groups, options.chance);
  return judge_all(graph, scores, decided_threshold(threshold, groups.truth),
                   enum_name(options.method));
}

}  // namespace

void JudgeEdgesOptions::validate() const { require_fields_in_range(*this); }

double jaccard_index(const WeightedGraph& graph, Index edge) {
  const auto [from, to, weight] = graph.edge(edge);
  return jaccard_index(
      count_neighbours(sorted_neighbours(graph, from), sorted_neighbours(graph, to), from == to));
}

WeightedGraph apply_verdicts(const WeightedGraph& graph, const EdgeVerdicts& verdicts,
                             bool keep_ambiguous) {
  std::vector<bool> keep;
  for (const auto& verdict : verdicts) keep.push_back(stays(verdict, keep_ambiguous));
  return filter_edges(graph, keep);
}

JudgeEdgesResult judge_edges(const WeightedGraph& graph, const JudgeEdgesOptions& options,
                             const Eigen::MatrixXd& positions, const RunContext& run) {
  options.validate();
  if (run.threads < 0) throw InvalidArgument("threads", "must not be negative");
  const auto start = std::chrono::steady_clock::now();
  auto result = options.method == EdgeScore::heat   ? judge_by_heat(graph, options, run)
                : options.method == EdgeScore::rank ? judge_by_rank(graph, options, positions, run)
                                                    : judge_by_threshold(graph, options, run);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace isotherm::spectral
