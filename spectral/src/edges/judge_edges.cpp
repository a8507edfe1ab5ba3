#include "isotherm/spectral/edges/judge_edges.hpp"

#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "edges/annealed_heat.hpp"
#include "edges/calibrated_heat.hpp"
#include "edges/control_threshold.hpp"
#include "edges/edge_scores.hpp"
#include "edges/pair_ranks.hpp"
#include "graph/bridges.hpp"
#include "graph/simple_graph.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/spectral/edges/multiscale_heat.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"

namespace isotherm::spectral {
namespace {

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
  } else if (score == detail::kUnknownScore) {
    verdict.verdict = Verdict::ambiguous;
    verdict.stage = "no evidence";
  } else if (score > threshold) {
    verdict.verdict = Verdict::prune;
  }
  return verdict;
}

/// What the rest of the graph says of a bridge: that a false edge would close a cycle, if the
/// graph was in one piece before it.
void spare_bridge(EdgeVerdict& verdict) {
  verdict.score = 0.0;
  verdict.verdict = Verdict::ambiguous;
  verdict.stage = "bridge";
}

/// What is known of the edges of a graph before any is measured.
struct Structure {
  detail::SimpleGraph simple;
  std::vector<bool> bridge;  // of the simple graph

  explicit Structure(const WeightedGraph& graph)
      : simple(detail::merge_parallel_edges(graph)), bridge(detail::find_bridges(simple.graph)) {}
};

/// Verdicts from the scores of the simple graph's edges.
JudgeEdgesResult judge_all(const WeightedGraph& graph, const Structure& structure,
                           const std::vector<double>& scores, const Threshold& threshold,
                           std::string_view stage) {
  JudgeEdgesResult result;
  result.threshold = threshold;
  for (Index e = 0; e < graph.edge_count(); ++e) {
    const Index edge = structure.simple.merged[e];
    const bool loop = edge == detail::SimpleGraph::kNone;
    auto verdict = judge(graph.edge(e), e, loop ? 0.0 : scores[edge], threshold.value, stage);
    if (!loop && structure.bridge[edge]) spare_bridge(verdict);
    result.verdicts.push_back(std::move(verdict));
  }
  return result;
}

/// What all that is measured says of the simple graph's edges.
detail::AnnealedHeat weigh_all(const Structure& structure, const JudgeEdgesOptions& options,
                               const RunContext& run) {
  return detail::anneal_heat(structure.simple.graph, {.rounds = options.rounds,
                                                      .chance = options.chance,
                                                      .control = options.control,
                                                      .places = options.places,
                                                      .seed = run.seed,
                                                      .threads = run.threads,
                                                      .progress = run.progress});
}

JudgeEdgesResult judge_by_heat(const WeightedGraph& graph, const Structure& structure,
                               const JudgeEdgesOptions& options, const RunContext& run) {
  const auto heat = weigh_all(structure, options, run);
  const std::string stage = "heat scale " + format_number(heat.scale) + " steps " +
                            std::to_string(heat.horizon) + (heat.in_plane ? " crossings" : "");
  return judge_all(graph, structure, heat.scores,
                   detail::decided_threshold(heat.threshold, heat.truth), stage);
}

void check_positions(const WeightedGraph& graph, const Eigen::MatrixXd& positions) {
  if (positions.cols() != graph.vertex_count() || positions.rows() == 0) {
    throw InvalidArgument("positions", "method rank needs one for each vertex");
  }
  if (!positions.allFinite()) throw InvalidArgument("positions", "must be finite");
}

/// Values of what may be false: of neither bridges nor edges about which nothing is known.
std::vector<double> in_question(const std::vector<double>& values,
                                const std::vector<double>& scores,
                                const std::vector<bool>& bridge) {
  std::vector<double> known;
  for (std::size_t e = 0; e < scores.size(); ++e) {
    if (!bridge[e] && std::isfinite(scores[e])) known.push_back(values[e]);
  }
  return known;
}

std::vector<double> konst_of(const JudgeEdgesOptions& options) {
  return options.konst.empty() ? std::vector{kDefaultKonst} : options.konst;
}

ThresholdRule rule_of(EdgeThreshold threshold) {
  switch (threshold) {
    case EdgeThreshold::control:
      break;
    case EdgeThreshold::mean_sigma:
      return ThresholdRule::mean_sigma;
    case EdgeThreshold::otsu:
      return ThresholdRule::otsu;
    case EdgeThreshold::mixture:
      return ThresholdRule::mixture;
    case EdgeThreshold::gap:
      return ThresholdRule::gap;
  }
  throw InvalidArgument("threshold", "is not a rule of scores alone");
}

detail::EdgeScores scores_of(const WeightedGraph& graph, const Structure& structure,
                             const JudgeEdgesOptions& options, const Eigen::MatrixXd& positions,
                             const RunContext& run) {
  const auto& edges = structure.simple.graph;
  if (options.method != EdgeScore::rank) return detail::score_edges(edges, options, run);
  check_positions(graph, positions);
  return {detail::pair_ranks(positions, edge_pairs(edges), run.threads, run.progress), {}};
}

JudgeEdgesResult judge_by_scores(const WeightedGraph& graph, const Structure& structure,
                                 const JudgeEdgesOptions& options, const Eigen::MatrixXd& positions,
                                 const RunContext& run) {
  auto [scores, warnings] = scores_of(graph, structure, options, positions, run);
  const auto questioned = in_question(scores, scores, structure.bridge);
  Threshold threshold;
  if (options.threshold == EdgeThreshold::control) {
    const auto truth =
        in_question(weigh_all(structure, options, run).truth, scores, structure.bridge);
    threshold = detail::control_threshold(questioned, truth);
    const auto doubts = detail::doubts_of(questioned, truth, threshold, enum_name(options.method));
    warnings.insert(warnings.end(), doubts.begin(), doubts.end());
  } else {
    threshold = find_threshold(
        questioned, {.rule = rule_of(options.threshold), .konst = konst_of(options).front()});
  }
  auto result = judge_all(graph, structure, scores, threshold, enum_name(options.method));
  result.warnings = std::move(warnings);
  return result;
}

MultiscaleHeatOptions multiscale_options(const JudgeEdgesOptions& options) {
  const bool other_rule = options.threshold != EdgeThreshold::control;
  return {.scales = options.scales,
          .threshold = other_rule ? rule_of(options.threshold) : ThresholdRule::mean_sigma,
          .konst = konst_of(options),
          .tolerance = options.tolerance};
}

/// Edges of the simple graph that are neither bridges nor trusted.
std::vector<Index> candidates(const Structure& structure, const std::vector<Index>& trusted) {
  auto out_of_question = structure.bridge;
  for (const Index edge : trusted) {
    if (edge < 0 || edge >= static_cast<Index>(structure.simple.merged.size())) {
      throw InvalidArgument("trusted", "no edge " + std::to_string(edge));
    }
    const Index merged = structure.simple.merged[edge];
    if (merged != detail::SimpleGraph::kNone) out_of_question[merged] = true;
  }
  std::vector<Index> edges;
  for (std::size_t e = 0; e < out_of_question.size(); ++e) {
    if (!out_of_question[e]) edges.push_back(static_cast<Index>(e));
  }
  return edges;
}

/// How many distances were found at all scales.
std::int64_t distance_count(const MultiscaleHeat& heat) {
  std::int64_t count = 0;
  for (const auto& round : heat.rounds) count += round.candidates;
  return count;
}

/// By eq. 11 where a konst is named.
MultiscaleHeat heat_of(const Structure& structure, const std::vector<Index>& judged,
                       const JudgeEdgesOptions& options, const RunContext& run) {
  const auto& graph = structure.simple.graph;
  const auto multiscale = multiscale_options(options);
  if (options.threshold != EdgeThreshold::control || !options.konst.empty()) {
    return multiscale_heat(graph, judged, multiscale, run);
  }
  const auto all = weigh_all(structure, options, run).truth;
  std::vector<double> truth;
  for (const Index edge : judged) truth.push_back(all[edge]);
  return detail::calibrated_heat(graph, judged, truth, multiscale, run);
}

JudgeEdgesResult judge_by_algorithm_1(const WeightedGraph& graph, const Structure& structure,
                                      const JudgeEdgesOptions& options, const RunContext& run) {
  const auto judged = candidates(structure, options.trusted);
  const auto heat = heat_of(structure, judged, options, run);
  std::vector<double> scores(structure.bridge.size(), 0.0);
  std::vector<std::string> stages(structure.bridge.size(), "trusted");
  std::vector<bool> pruned(structure.bridge.size(), false);
  for (std::size_t k = 0; k < judged.size(); ++k) {
    scores[judged[k]] = heat.verdicts[k].score;
    stages[judged[k]] = heat.verdicts[k].stage;
    pruned[judged[k]] = heat.verdicts[k].pruned;
  }
  auto result = judge_all(graph, structure, scores, {.value = 1.0}, "trusted");
  if (heat.imprecise > 0) {
    result.warnings.push_back(
        words_of_imprecise(heat.imprecise, distance_count(heat), "heat distances"));
  }
  for (auto& verdict : result.verdicts) {
    const Index edge = structure.simple.merged[verdict.edge];
    if (edge == detail::SimpleGraph::kNone || structure.bridge[edge]) continue;
    verdict.stage = stages[edge];
    verdict.verdict = pruned[edge] ? Verdict::prune : Verdict::keep;
  }
  return result;
}

}  // namespace

void JudgeEdgesOptions::validate() const {
  require_fields_in_range(*this);
  multiscale_options(*this).validate();
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
  const Structure structure(graph);
  auto result = options.method == EdgeScore::heat ? judge_by_heat(graph, structure, options, run)
                : options.method == EdgeScore::heat_multiscale
                    ? judge_by_algorithm_1(graph, structure, options, run)
                    : judge_by_scores(graph, structure, options, positions, run);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace isotherm::spectral
