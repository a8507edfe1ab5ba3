#include "isotherm/slam/simulate/corrupt.hpp"
#include "isotherm/base/words.hpp"

#include <memory>
#include <variant>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/slam/evaluate/ground_truth.hpp"
#include "isotherm/slam/graph/odometry.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "option_verb.hpp"
#include "verbs/input/pose_graph_input.hpp"
#include "verbs/input/truth_input.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;

struct CorruptVerb : OptionVerb<CorruptOptions> {
  std::string input;
  std::string output;
  std::string labels;
  std::string ground_truth;

  int run() {
    if (resolve_or_dump()) return kOk;
    options.seed = flags.seed;
    const auto file = read_input_graph({input}, flags);
    return std::visit([this](const auto& graph) { return corrupt_graph(graph); }, file.graph);
  }

  template <class Pose>
  int corrupt_graph(const PoseGraph<Pose>& graph) {
    const auto corrupted = corrupt(graph, true_poses(graph), options);
    write_g2o(output, corrupted.graph);
    if (!labels.empty()) write_labels(labels, corrupted.labels);
    const auto correct = count(corrupted.labels, Label::correct);
    const auto incorrect = count(corrupted.labels, Label::incorrect);
    const auto ignored = count(corrupted.labels, Label::ignore);
    say(flags,
        fmt::format("corrupted: {} of the input, {} added{}", counted(correct, "loop"),
                    counted(incorrect + ignored, "false loop"),
                    ignored > 0 ? fmt::format(", {} of them consistent by chance", ignored) : ""));
    write_json(flags.json, {{"schema", "isotherm.corrupt/1"},
                            {"correct", correct},
                            {"incorrect", incorrect},
                            {"ignore", ignored},
                            {"options", options_to_json(options)}});
    return kOk;
  }

  // What the labels of false loops are measured against.
  template <class Pose>
  std::vector<Pose> true_poses(const PoseGraph<Pose>& graph) const {
    if (!ground_truth.empty()) {
      const auto found = read_truth(graph, {.path = ground_truth}, flags);
      std::vector<Pose> poses;
      for (std::size_t v = 0; v < found.size(); ++v) {
        if (!found[v]) {
          throw InvalidArgument("ground-truth",
                                fmt::format("has no pose for vertex {}", graph.ids[v]));
        }
        poses.push_back(*found[v]);
      }
      return poses;
    }
    if (!graph.poses.empty()) return graph.poses;
    return odometry_poses(graph, edge_roles(graph));
  }
};

}  // namespace

Verb add_corrupt(CLI::App& root) {
  auto corrupt = std::make_shared<CorruptVerb>();
  CLI::App* verb = root.add_subcommand("corrupt", "add false loop closures to a pose graph");
  verb->add_option("input", corrupt->input, "clean pose graph (- for stdin)")->required();
  auto& outputs = corrupt->flags.outputs;
  outputs
      .add(*verb, "-o,--output", corrupt->output, "pose graph to write (- for stdout)", {".g2o"})
      ->required();
  outputs.add(*verb, "--labels", corrupt->labels, "labels to write, as CSV", {".csv"});
  verb->add_option("--ground-truth", corrupt->ground_truth,
                   "true poses as g2o; without it the input's own poses count as true")
      ->type_name("FILE");
  corrupt->add_flags(*verb);
  return verb_of(verb, corrupt);
}

}  // namespace isotherm::apps
