#include "isotherm/slam/prune/heat_prune.hpp"

#include <limits>

#include "graph/candidate_verdicts.hpp"

namespace isotherm::slam {
namespace {

using spectral::Verdict;

void take_over(const spectral::MultiscaleHeat& heat, const HeatQuestion& question,
               HeatPruneResult& result) {
  for (std::size_t k = 0; k < question.candidates.size(); ++k) {
    auto& verdict = result.verdicts[question.candidates[k]];
    verdict.verdict = heat.verdicts[k].pruned ? Verdict::prune : Verdict::keep;
    verdict.score = heat.verdicts[k].score;
    verdict.stage = heat.verdicts[k].stage;
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& distances : heat.distances) {
    std::vector<double> all(result.verdicts.size(), nan);
    for (std::size_t k = 0; k < distances.size(); ++k) all[question.candidates[k]] = distances[k];
    result.distances.push_back(std::move(all));
  }
}

}  // namespace

void HeatPruneOptions::validate() const {
  require_fields_in_range(*this);
  multiscale_options(*this).validate();
  induction.validate();
}

spectral::MultiscaleHeatOptions multiscale_options(const HeatPruneOptions& options) {
  return {.scales = options.scales,
          .threshold = options.threshold,
          .konst = options.konst,
          .min_separation = options.min_separation,
          .tolerance = options.tolerance};
}

HeatPruneOptions datta2016() {
  HeatPruneOptions options;
  options.scales = {};
  options.threshold = spectral::ThresholdRule::mean_sigma;
  options.induction.loop_weight = 0.1;
  options.induction.curve.comparison = CurveComparison::lap_line;
  return options;
}

template <class Pose>
HeatQuestion heat_question(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                           const HeatPruneOptions& options, const RunContext& run) {
  options.validate();
  HeatQuestion question{induce(graph, roles, options.induction, run), {}, {}};
  for (std::size_t c = 0; c < roles.candidates.size(); ++c) {
    const Index edge = question.induced.constraint_edge[roles.candidates[c]];
    if (edge < 0) continue;
    question.candidates.push_back(c);
    question.edges.push_back(edge);
  }
  return question;
}

template <class Pose>
HeatPruneResult heat_verdicts(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                              const HeatQuestion& question, spectral::MultiscaleHeat answer) {
  const auto& induced = question.induced;
  HeatPruneResult result;
  result.verdicts = detail::candidate_verdicts(graph, roles);
  for (std::size_t c = 0; c < roles.candidates.size(); ++c) {
    const Index edge = induced.constraint_edge[roles.candidates[c]];
    result.weights.push_back(edge < 0 ? 0.0 : induced.graph.edge(edge).weight);
    auto& verdict = result.verdicts[c];
    verdict.threshold = 1.0;
    verdict.verdict = Verdict::prune;
    verdict.score = std::numeric_limits<double>::infinity();
    verdict.stage = "induction";
  }
  take_over(answer, question, result);
  result.rounds = std::move(answer.rounds);
  result.unconverged = answer.unconverged;
  result.widest_bracket = answer.widest_bracket;
  return result;
}

template <class Pose>
HeatPruneResult heat_prune(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                           const HeatPruneOptions& options, const RunContext& run) {
  const auto question = heat_question(graph, roles, options, run);
  return heat_verdicts(
      graph, roles, question,
      multiscale_heat(question.induced.graph, question.edges, multiscale_options(options), run));
}

template HeatQuestion heat_question(const PoseGraph<Pose2>&, const EdgeRoles&,
                                    const HeatPruneOptions&, const RunContext&);
template HeatPruneResult heat_verdicts(const PoseGraph<Pose2>&, const EdgeRoles&,
                                       const HeatQuestion&, spectral::MultiscaleHeat);
template HeatPruneResult heat_prune(const PoseGraph<Pose2>&, const EdgeRoles&,
                                    const HeatPruneOptions&, const RunContext&);
template HeatQuestion heat_question(const PoseGraph<Pose3>&, const EdgeRoles&,
                                    const HeatPruneOptions&, const RunContext&);
template HeatPruneResult heat_verdicts(const PoseGraph<Pose3>&, const EdgeRoles&,
                                       const HeatQuestion&, spectral::MultiscaleHeat);
template HeatPruneResult heat_prune(const PoseGraph<Pose3>&, const EdgeRoles&,
                                    const HeatPruneOptions&, const RunContext&);

}  // namespace isotherm::slam
