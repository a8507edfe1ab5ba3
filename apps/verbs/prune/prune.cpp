#include <algorithm>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/slam/evaluate/ground_truth.hpp"
#include "isotherm/slam/graph/usable_odometry.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/slam/pipeline.hpp"
#include "report/build/pose_graph_report.hpp"
#include "report/report_flags.hpp"
#include "verbs/input/pose_graph_input.hpp"
#include "verbs/input/truth_input.hpp"
#include "verbs/prune/prune_flags.hpp"
#include "verbs/prune/prune_result.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;
using spectral::Verdict;

struct PruneVerb {
  CommonFlags flags;
  PruneFlags method;
  PipelineOptions options;
  std::vector<std::string> input;
  std::string output;
  std::string verdicts;
  std::string trusted;
  ReportFlags explain;
  GroundTruthSource truth;

  int run() {
    options.prune = method.resolve(read_config(flags));
    if (flags.dump_config) {
      write_json("-", options_to_json(options.prune));
      return kOk;
    }
    std::visit([](const auto& own) { own.validate(); }, options.prune);
    require_use_of_truth();
    if (!explain.wanted()) options.optimize.reset();
    auto file = read_input_graph(input, flags);
    std::visit([&](auto& graph) { run_on(graph, file); }, file.graph);
    return kOk;
  }

  // `graph` is the one in `file`.
  template <class Pose>
  void run_on(PoseGraph<Pose>& graph, const PoseGraphFile& file) {
    const RunContext context{flags.threads, progress_line(flags), flags.seed};
    const auto roles = roles_of(graph, trusted);
    if (flags.strict) require_usable_odometry(graph, roles, file);
    PruneRun<Pose> input_run{files_title(input), options, {}, robots_of(file)};
    if (!truth.path.empty()) input_run.truth = read_truth(graph, truth, flags);
    auto doubts = warn_of_doubts(graph, roles, flags);
    if (file.report.notes.contains("turn beyond a full one")) {
      doubts.push_back({"angles in degrees", ""});  // said when they were read
    }
    auto result = prune_and_optimize(graph, roles, options, context);
    tell(result.decisions, flags);
    warn_of_loss(result.decisions.verdicts, doubts);
    std::optional<Report> page;
    if (explain.wanted()) page = pose_graph_report(graph, result, input_run, context);
    // Poses stay as they came: they are for 'optimize' to find.
    graph.constraints = std::move(result.pruned.constraints);
    if (!output.empty()) write_g2o(output, file);
    if (!verdicts.empty()) write_loop_verdicts(verdicts, result.decisions.verdicts, graph.ids);
    write_json(flags.json, to_json(result.decisions, options.prune));
    if (page) write_report(explain, *page);
  }

  // Methods repair it, which is what --strict forbids.
  template <class Pose>
  void require_usable_odometry(const PoseGraph<Pose>& graph, const EdgeRoles& roles,
                               const PoseGraphFile& file) const {
    const auto unusable = unusable_information(graph, roles);
    if (unusable.empty()) return;
    const auto line = graph.constraints[unusable.front()].line;
    throw ParseError({file.report.path, line, 0}, "", describe_unusable(graph, unusable));
  }

  // A map without its loops is seldom what was wanted.
  void warn_of_loss(const spectral::EdgeVerdicts& all, const std::vector<Doubt>& doubts) const {
    constexpr std::size_t kFew = 10;
    const auto pruned = count(all, Verdict::prune);
    if (all.size() < kFew || 10 * pruned <= 9 * static_cast<std::int64_t>(all.size())) return;
    std::string causes;
    for (const auto& doubt : doubts) causes += (causes.empty() ? "" : ", ") + doubt.kind + "?";
    if (causes.empty()) {
      causes =
          "angles in degrees, ends swapped, information that is a covariance or in another "
          "order?";
    }
    warn(flags, fmt::format("{} of {} loops are pruned. If most of them should be true: {} "
                            "('isotherm info' shows what is odd)",
                            pruned, all.size(), causes));
  }

  // What would be read and play no part is not what was meant.
  void require_use_of_truth() const {
    if (!truth.path.empty()) explain.require_wanted("--ground-truth");
    if (!truth.timestamps.empty() && truth.path.empty()) {
      throw InvalidArgument("--timestamps", "are those of --ground-truth, which is missing");
    }
  }
};

}  // namespace

Verb add_prune(CLI::App& root) {
  auto prune = std::make_shared<PruneVerb>();
  CLI::App* verb = root.add_subcommand("prune", "remove false loop closures from a pose graph");
  add_graph_inputs(*verb, prune->input, "pose graph, or several files of one (- for stdin)");
  auto& outputs = prune->flags.outputs;
  outputs.add(*verb, "-o,--output", prune->output, "pruned pose graph to write (- for stdout)",
              {".g2o"});
  outputs.add(*verb, "--verdicts", prune->verdicts, "decision and reason a loop, as CSV", {".csv"});
  verb->add_flag("--keep-ambiguous", prune->options.keep_ambiguous,
                 "leave loops that are not proven either way in the graph");
  verb->add_option("--trusted", prune->trusted,
                   "CSV of edges to trust in place of odometry (edge, or from,to)")
      ->type_name("FILE");
  prune->explain.add_to(*verb, outputs);
  verb->add_option("--ground-truth", prune->truth.path,
                   "true poses, for the trajectory error in the report")
      ->type_name("FILE");
  verb->add_option("--timestamps", prune->truth.timestamps,
                   "time of each pose in seconds, one a line, where the truth needs it")
      ->type_name("FILE");
  add_truth_flags(*verb, prune->truth);
  prune->method.add_to(*verb);
  add_common_flags(*verb, prune->flags);
  return verb_of(verb, prune);
}

}  // namespace isotherm::apps
