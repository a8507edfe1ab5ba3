#include <memory>
#include <vector>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/slam/evaluate/labels.hpp"
#include "isotherm/slam/prune/loop_evidence.hpp"
#include "isotherm/spectral/edges/verdict_file.hpp"
#include "option_verb.hpp"
#include "verbs/input/pose_graph_input.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;

struct EvalEvidence : OptionVerb<ConsensusOptions> {
  std::vector<std::string> input;
  std::string verdicts;
  std::string labels;
  std::string trusted;

  int run() {
    if (resolve_or_dump()) return kOk;
    if (verdicts.empty() && labels.empty()) {
      throw InvalidArgument("eval evidence", "needs --verdicts or --labels");
    }
    const auto kept = kept_edges();
    auto file = read_input_graph(input, flags);
    const double evidence = std::visit(
        [&](const auto& graph) {
          const auto roles = roles_of(graph, trusted);
          return loop_evidence(graph, roles, kept, options, {flags.threads, progress_line(flags)});
        },
        file.graph);
    if (flags.json != "-") write_text("-", fmt::format("log evidence {:.3f}\n", evidence));
    write_json(flags.json, {{"schema", "isotherm.eval.evidence/1"},
                            {"log_evidence", evidence},
                            {"loops", kept.size()}});
    return kOk;
  }

  // All that are not pruned, or labelled as correct.
  std::vector<Index> kept_edges() const {
    std::vector<Index> kept;
    if (!labels.empty()) {
      for (const auto& row : read_labels(labels)) {
        if (row.label == Label::correct) kept.push_back(static_cast<Index>(row.edge));
      }
    } else {
      for (const auto& row : spectral::read_verdicts(verdicts)) {
        if (spectral::stays(row, true)) kept.push_back(static_cast<Index>(row.edge));
      }
    }
    return kept;
  }
};

}  // namespace

Verb add_eval_evidence(CLI::App& eval) {
  auto evidence = std::make_shared<EvalEvidence>();
  CLI::App* verb = eval.add_subcommand(
      "evidence", "log evidence that just the loops which some verdicts leave are true");
  add_graph_inputs(*verb, evidence->input, "pose graph that the verdicts are of");
  CLI::Option* labels = verb->add_option("--labels", evidence->labels,
                                         "labels; those of the correct loops are meant");
  verb->add_option("--verdicts", evidence->verdicts, "verdicts written by prune")->excludes(labels);
  verb->add_option("--trusted", evidence->trusted,
                   "CSV of edges to trust in place of odometry (edge, or from,to)")
      ->type_name("FILE");
  evidence->add_flags(*verb);
  return verb_of(verb, evidence);
}

}  // namespace isotherm::apps
