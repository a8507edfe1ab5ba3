#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "console.hpp"
#include "distributed/ranks.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/slam/prune/prune.hpp"
#include "verbs/input/pose_graph_input.hpp"
#include "verbs/prune/prune_result.hpp"

namespace isotherm::apps {
namespace {

using slam::EdgeRoles;
using slam::HeatPruneOptions;
using slam::HeatQuestion;
using slam::PoseGraph;

/// Poses are on rank 0, which weighs the loops and writes what comes of it; the weighted graph that
/// heat flows through, and the heat, are spread over all.
struct DistributedPrune : OptionVerb<HeatPruneOptions> {
  std::vector<std::string> input;
  std::string output;
  std::string verdicts;
  std::string trusted;

  int run(const distributed::Session& session) {
    if (only_dumps(session, *this)) return kOk;
    const auto start = std::chrono::steady_clock::now();
    const bool first = session.rank() == 0;
    slam::PoseGraphFile file;
    EdgeRoles roles;
    HeatQuestion question;
    session.together([&] {
      if (first) file = read_input_graph(input, flags);
      if (first) std::visit([&](auto& graph) { ask(graph, roles, question); }, file.graph);
    });
    auto answer = judge(session, question);
    session.together([&] {
      if (!first) return;
      std::visit([&](auto& graph) { decide(graph, file, roles, question, answer, start); },
                 file.graph);
    });
    return kOk;
  }

  template <class Pose>
  void ask(const PoseGraph<Pose>& graph, EdgeRoles& roles, HeatQuestion& question) const {
    roles = roles_of(graph, trusted);
    warn_of_doubts(graph, roles, flags);
    question = heat_question(graph, roles, options, {1, progress_line(flags), flags.seed});
  }

  // Rank 0 asks for all; the others have no edges of their own, but their part of the graph.
  spectral::MultiscaleHeat judge(const distributed::Session& session,
                                 const HeatQuestion& question) const {
    const auto& induced = question.induced.graph;
    const auto vertices = static_cast<Index>(session.sum(induced.vertex_count()));
    const auto graph = distributed::Graph::from_edges(session, vertices, induced.edges());
    std::vector<bool> candidate(induced.edges().size(), false);
    for (const Index edge : question.edges) candidate[edge] = true;
    auto answer = distributed::multiscale_heat(graph, candidate, multiscale_options(options),
                                               {.progress = progress_line(flags)});
    std::vector<spectral::MultiscaleVerdict> of_edges;
    for (const Index edge : question.edges) of_edges.push_back(std::move(answer.verdicts[edge]));
    answer.verdicts = std::move(of_edges);
    return answer;
  }

  template <class Pose>
  void decide(PoseGraph<Pose>& graph, const slam::PoseGraphFile& file, const EdgeRoles& roles,
              const HeatQuestion& question, const spectral::MultiscaleHeat& answer,
              std::chrono::steady_clock::time_point start) const {
    auto result = slam::prune_result(heat_verdicts(graph, roles, question, answer));
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    result.seconds = passed.count();
    tell(result, flags);
    if (!output.empty()) {
      graph.constraints = std::move(apply_verdicts(graph, result.verdicts).constraints);
      write_g2o(output, file);
    }
    if (!verdicts.empty()) write_loop_verdicts(verdicts, result.verdicts, graph.ids);
    write_json(flags.json, to_json(result, options));
  }
};

}  // namespace

Verb add_distributed_prune(CLI::App& root, const distributed::Session& session) {
  auto prune = std::make_shared<DistributedPrune>();
  CLI::App* verb =
      root.add_subcommand("prune", "remove false loop closures from a pose graph, by heat");
  add_graph_inputs(*verb, prune->input, "pose graph, or several files of one");
  auto& outputs = prune->flags.outputs;
  outputs.add(*verb, "-o,--output", prune->output, "pruned pose graph to write (- for stdout)",
              {".g2o"});
  outputs.add(*verb, "--verdicts", prune->verdicts, "decision and reason a loop, as CSV", {".csv"});
  verb->add_option("--trusted", prune->trusted,
                   "CSV of edges to trust in place of odometry (edge, or from,to)")
      ->type_name("FILE");
  prune->add_flags(*verb);
  return verb_on_ranks(verb, prune, session);
}

}  // namespace isotherm::apps
