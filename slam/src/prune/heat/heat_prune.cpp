#include "isotherm/slam/prune/heat_prune.hpp"

#include <limits>

#include "graph/candidate_verdicts.hpp"

namespace isotherm::slam {
namespace {

using spectral::ThresholdRule;
using spectral::Verdict;

spectral::MultiscaleHeatOptions multiscale(const HeatPruneOptions& options) {
  return {.scales = options.scales,
          .threshold = options.threshold,
          .konst = options.konst,
          .min_separation = options.min_separation,
          .tolerance = options.tolerance};
}

/// The candidates that have an edge, and their edges.
struct Judged {
  std::vector<std::size_t> candidates;
  std::vector<Index> edges;
};

Judged judged(const EdgeRoles& roles, const InducedGraph& induced) {
  Judged judged;
  for (std::size_t c = 0; c < roles.candidates.size(); ++c) {
    const Index edge = induced.constraint_edge[roles.candidates[c]];
    if (edge < 0) continue;
    judged.candidates.push_back(c);
    judged.edges.push_back(edge);
  }
  return judged;
}

void take_over(const spectral::MultiscaleHeat& heat, const Judged& judged,
               HeatPruneResult& result) {
  for (std::size_t k = 0; k < judged.candidates.size(); ++k) {
    auto& verdict = result.verdicts[judged.candidates[k]];
    verdict.verdict = heat.verdicts[k].pruned ? Verdict::prune : Verdict::keep;
    verdict.score = heat.verdicts[k].score;
    verdict.stage = heat.verdicts[k].stage;
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& distances : heat.distances) {
    std::vector<double> all(result.verdicts.size(), nan);
    for (std::size_t k = 0; k < distances.size(); ++k) all[judged.candidates[k]] = distances[k];
    result.distances.push_back(std::move(all));
  }
}

}  // namespace

void HeatPruneOptions::validate() const {
  require_fields_in_range(*this);
  multiscale(*this).validate();
  induction.validate();
}

HeatPruneOptions datta2016() {
  HeatPruneOptions options;
  options.scales = {};
  options.threshold = ThresholdRule::mean_sigma;
  options.induction.loop_weight = 0.1;
  options.induction.curve.comparison = CurveComparison::lap_line;
  return options;
}

template <class Pose>
HeatPruneResult heat_prune(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                           const HeatPruneOptions& options, const RunContext& run) {
  options.validate();
  const auto induced = induce(graph, roles, options.induction, run);
  const auto judged_loops = judged(roles, induced);
  auto heat = multiscale_heat(induced.graph, judged_loops.edges, multiscale(options), run);

  HeatPruneResult result;
  result.verdicts = candidate_verdicts(graph, roles);
  for (std::size_t c = 0; c < roles.candidates.size(); ++c) {
    const Index edge = induced.constraint_edge[roles.candidates[c]];
    result.weights.push_back(edge < 0 ? 0.0 : induced.graph.edge(edge).weight);
    auto& verdict = result.verdicts[c];
    verdict.threshold = 1.0;
    verdict.verdict = Verdict::prune;
    verdict.score = std::numeric_limits<double>::infinity();
    verdict.stage = "induction";
  }
  take_over(heat, judged_loops, result);
  result.rounds = std::move(heat.rounds);
  result.unconverged = heat.unconverged;
  result.widest_bracket = heat.widest_bracket;
  return result;
}

template HeatPruneResult heat_prune(const PoseGraph<Pose2>&, const EdgeRoles&,
                                    const HeatPruneOptions&, const RunContext&);
template HeatPruneResult heat_prune(const PoseGraph<Pose3>&, const EdgeRoles&,
                                    const HeatPruneOptions&, const RunContext&);

}  // namespace isotherm::slam
