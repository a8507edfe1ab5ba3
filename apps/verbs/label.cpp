#include <memory>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/base/words.hpp"
#include "isotherm/slam/evaluate/ground_truth.hpp"
#include "isotherm/slam/evaluate/labels.hpp"
#include "option_verb.hpp"
#include "verbs/input/pose_graph_input.hpp"
#include "verbs/input/truth_input.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;

struct LabelVerb : OptionVerb<LabelOptions> {
  std::vector<std::string> input;
  std::string output;
  GroundTruthSource truth;

  int run() {
    if (resolve_or_dump()) return kOk;
    const auto file = read_input_graph(input, flags);
    const auto labels = std::visit([this](const auto& graph) { return label(graph); }, file.graph);
    write_labels(output, labels);
    const auto incorrect = count(labels, Label::incorrect);
    const auto ignored = count(labels, Label::ignore);
    say(flags, fmt::format("labelled {}: {} incorrect, {} without ground truth",
                           counted(labels.size(), "loop"), incorrect, ignored));
    write_json(flags.json, {{"schema", "isotherm.label/1"},
                            {"labels", labels.size()},
                            {"correct", count(labels, Label::correct)},
                            {"incorrect", incorrect},
                            {"ignore", ignored},
                            {"options", options_to_json(options)}});
    return kOk;
  }

  template <class Pose>
  std::vector<EdgeLabel> label(const PoseGraph<Pose>& graph) const {
    return label_candidates(graph, edge_roles(graph), read_truth(graph, truth, flags), options);
  }
};

}  // namespace

Verb add_label(CLI::App& root) {
  auto label = std::make_shared<LabelVerb>();
  CLI::App* verb = root.add_subcommand("label", "label loop closures by ground truth");
  add_graph_inputs(*verb, label->input, "pose graph, or several files of one (- for stdin)");
  verb->add_option("--ground-truth", label->truth.path,
                   "g2o, CSV (time,x,y,theta), TUM, KITTI or EuRoC file")
      ->required()
      ->type_name("FILE");
  verb->add_option("--timestamps", label->truth.timestamps,
                   "time of each vertex in seconds, one a line")
      ->type_name("FILE");
  add_number(*verb, "--max-gap", label->truth.max_gap,
             "seconds to the nearest sample beyond which there is no truth; 0: any", closed(0, 1e9))
      ->default_str("0");
  add_truth_flags(*verb, label->truth);
  label->flags.outputs
      .add(*verb, "-o,--output", label->output, "labels to write, as CSV (- for stdout)", {".csv"})
      ->required();
  label->add_flags(*verb);
  return verb_of(verb, label);
}

}  // namespace isotherm::apps
