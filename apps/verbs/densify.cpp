#include "isotherm/slam/simulate/densify.hpp"

#include <memory>
#include <variant>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/base/words.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "option_verb.hpp"
#include "verbs/input/pose_graph_input.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

struct DensifyVerb : OptionVerb<slam::DensifyOptions> {
  std::string input;
  std::string output;

  int run() {
    if (resolve_or_dump()) return kOk;
    const auto file = read_input_graph({input}, flags);
    return std::visit([this](const auto& graph) { return densify_graph(graph); }, file.graph);
  }

  template <class Pose>
  int densify_graph(const slam::PoseGraph<Pose>& graph) {
    const auto roles = slam::edge_roles(graph);
    const auto dense = slam::densify(graph, roles, options);
    slam::write_g2o(output, dense);
    const auto added = dense.constraint_count() - graph.constraint_count();
    say(flags,
        fmt::format("densified: {} of the input, {} added",
                    counted(roles.candidates.size(), "loop"), counted(added, "copy", "copies")));
    write_json(flags.json, {{"schema", "isotherm.densify/1"},
                            {"loops", roles.candidates.size()},
                            {"copies_added", added},
                            {"options", options_to_json(options)}});
    return kOk;
  }
};

}  // namespace

Verb add_densify(CLI::App& root) {
  auto densify = std::make_shared<DensifyVerb>();
  CLI::App* verb =
      root.add_subcommand("densify", "replicate sparse loop closures in their neighbourhood");
  verb->add_option("input", densify->input, "pose graph (- for stdin)")->required();
  densify->flags.outputs
      .add(*verb, "-o,--output", densify->output, "pose graph to write (- for stdout)", {".g2o"})
      ->required();
  densify->add_flags(*verb);
  return verb_of(verb, densify);
}

}  // namespace isotherm::apps
