#include "isotherm/slam/prune/prune.hpp"

#include <cmath>
#include <memory>
#include <optional>
#include <variant>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/slam/evaluate/ground_truth.hpp"
#include "isotherm/slam/graph/trusted_edges.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/spectral/edges/verdict_file.hpp"
#include "option_verb.hpp"
#include "report/build/pose_graph_report.hpp"
#include "report/report_flags.hpp"
#include "verbs/pose_graph_input.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;
using spectral::Verdict;

// JSON has no infinity; null stands for "no threshold".
Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json to_json(const HeatRound& round) {
  return {{"scale", round.scale},           {"threshold", finite_or_null(round.threshold)},
          {"separation", round.separation}, {"konst", round.konst},
          {"candidates", round.candidates}, {"pruned", round.pruned}};
}

// Why each candidate was decided as it was; edges are numbered as in the verdicts.
Json to_json(const ConsensusDetail& detail, const spectral::EdgeVerdict& verdict) {
  return {{"edge", verdict.edge},
          {"chi2", finite_or_null(detail.chi2)},
          {"evidence", finite_or_null(detail.evidence)},
          {"round", detail.round},
          {"conflicts", detail.conflicts}};
}

Json to_json(const ConsensusResult& result, const spectral::EdgeVerdicts& verdicts) {
  Json json = {{"inlier_fraction", result.inlier_fraction},
               {"odometry_scale", result.odometry_scale},
               {"loop_scale", result.loop_scale},
               {"tail_factor", result.tail_factor},
               {"settled", result.settled},
               {"rounds", Json::array()},
               {"loops", Json::array()}};
  for (const auto& round : result.rounds) {
    json["rounds"].push_back({{"rule", round.rule},
                              {"accepted", round.accepted},
                              {"dropped", round.dropped},
                              {"in_force", round.in_force}});
  }
  for (std::size_t k = 0; k < result.details.size(); ++k) {
    json["loops"].push_back(to_json(result.details[k], verdicts[k]));
  }
  return json;
}

Json to_json(const PruneResult& result, const PruneOptions& options) {
  Json json = {{"schema", "isotherm.prune/1"},
               {"method", enum_name(result.method)},
               {"candidates", result.verdicts.size()},
               {"kept", count(result.verdicts, Verdict::keep)},
               {"pruned", count(result.verdicts, Verdict::prune)},
               {"ambiguous", count(result.verdicts, Verdict::ambiguous)},
               {"seconds", result.seconds},
               {"warnings", result.warnings},
               {"options", options_to_json(options)}};
  if (!result.rounds.empty()) {
    json["rounds"] = Json::array();
    for (const auto& round : result.rounds) json["rounds"].push_back(to_json(round));
  }
  if (result.method == PruneMethod::consensus) {
    json["consensus"] = to_json(result.consensus, result.verdicts);
  }
  return json;
}

struct PruneVerb : OptionVerb<PruneOptions> {
  std::string input;
  std::string output;
  std::string verdicts;
  std::string preset;
  std::string trusted;
  bool keep_ambiguous = false;
  ReportFlags explain;
  GroundTruthSource truth;

  int run() {
    if (preset == "datta2016") options.heat = datta2016();
    if (resolve_or_dump()) return kOk;
    options.threads = flags.threads;
    options.progress = progress_line(flags);
    auto file = read_input_graph(input, flags);
    std::visit([&](auto& graph) { run_on(graph, file); }, file.graph);
    return kOk;
  }

  // `graph` is the one in `file`.
  template <class Pose>
  void run_on(PoseGraph<Pose>& graph, const PoseGraphFile& file) {
    const auto roles = trusted.empty() ? edge_roles(graph) : read_trusted_edges(trusted, graph);
    const auto result = prune(graph, roles, options);
    report(result);
    std::optional<Report> page;
    if (explain.wanted()) page = explained(graph, roles, result);
    graph = apply_verdicts(graph, result.verdicts, keep_ambiguous);
    if (!output.empty()) write_g2o(output, file);
    if (!verdicts.empty()) spectral::write_verdicts(verdicts, result.verdicts);
    write_json(flags.json, to_json(result, options));
    if (page) write_report(explain, *page);
  }

  template <class Pose>
  Report explained(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                   const PruneResult& result) const {
    PruneRun<Pose> run{file_title(input), options, keep_ambiguous, {}};
    if (!truth.path.empty()) run.truth = read_ground_truth(graph, truth);
    return pose_graph_report(graph, roles, result, run);
  }

  void report(const PruneResult& result) const {
    for (const auto& warning : result.warnings) warn(flags, warning);
    for (const auto& round : result.consensus.rounds) {
      detail_line(flags, fmt::format("{:>9}: {} loops accepted, {} dropped, {} in force",
                                     round.rule, round.accepted, round.dropped, round.in_force));
    }
    for (const auto& round : result.rounds) {
      detail_line(flags, fmt::format("scale {:>6}: {} of {} loops pruned, threshold {:.4g}",
                                     round.scale, round.pruned, round.candidates, round.threshold));
    }
    say(flags,
        fmt::format("{}: {} loops, {} kept, {} pruned, {} ambiguous, {:.2f} s",
                    enum_name(result.method), result.verdicts.size(),
                    count(result.verdicts, Verdict::keep), count(result.verdicts, Verdict::prune),
                    count(result.verdicts, Verdict::ambiguous), result.seconds));
  }
};

}  // namespace

Verb add_prune(CLI::App& root) {
  auto prune = std::make_shared<PruneVerb>();
  CLI::App* verb = root.add_subcommand("prune", "remove false loop closures from a pose graph");
  verb->add_option("input", prune->input, "pose graph (- for stdin)")->required();
  verb->add_option("-o,--output", prune->output, "pruned pose graph to write (- for stdout)")
      ->type_name("FILE");
  verb->add_option("--verdicts", prune->verdicts, "decision and reason a loop, as CSV")
      ->type_name("FILE");
  verb->add_flag("--keep-ambiguous", prune->keep_ambiguous,
                 "leave loops that are not proven either way in the graph");
  verb->add_option("--trusted", prune->trusted,
                   "CSV of edges to trust in place of odometry (edge, or from,to)")
      ->type_name("FILE");
  verb->add_option("--preset", prune->preset, "datta2016: heat as the paper states it")
      ->check(CLI::IsMember({"datta2016"}));
  prune->explain.add_to(*verb);
  verb->add_option("--ground-truth", prune->truth.path,
                   "true poses, for the trajectory error in the report")
      ->type_name("FILE");
  verb->add_option("--timestamps", prune->truth.timestamps,
                   "time of each pose in seconds, one a line, where the truth needs it")
      ->type_name("FILE");
  prune->add_flags(*verb);
  return {verb, [prune] { return prune->run(); }};
}

}  // namespace isotherm::apps
