#include "isotherm/slam/simulate/simulate.hpp"
#include "isotherm/base/words.hpp"

#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "option_verb.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;

// What the worlds differ in: their options, and the function that makes them.
template <class Options, auto simulate_world>
struct SimulateWorld : OptionVerb<Options> {
  using OptionVerb<Options>::flags;
  using OptionVerb<Options>::options;

  std::string world;
  std::string output;
  std::string ground_truth;

  int run() {
    if (this->resolve_or_dump()) return kOk;
    options.seed = flags.seed;
    report(simulate_world(options));
    return kOk;
  }

  template <class Pose>
  void report(const Simulation<Pose>& simulation) const {
    const auto& graph = simulation.graph;
    write_g2o(output, graph);
    if (!ground_truth.empty()) {
      write_g2o(ground_truth, PoseGraph<Pose>{graph.ids, simulation.truth, {}, {}});
    }
    const auto roles = edge_roles(graph);
    const double drift =
        (graph.poses.back().translation() - simulation.truth.back().translation()).norm();
    say(flags, fmt::format("{}: {}, {}, {}, odometry ends {:.2f} m off", world,
                           counted(graph.ids.size(), "pose"),
                           counted(roles.odometry.size(), "odometry edge"),
                           counted(roles.candidates.size(), "loop"), drift));
    write_json(flags.json, {{"schema", "isotherm.simulate/1"},
                            {"world", world},
                            {"poses", graph.vertex_count()},
                            {"odometry", roles.odometry.size()},
                            {"loops", roles.candidates.size()},
                            {"drift_m", drift},
                            {"options", options_to_json(options)}});
  }
};

template <class Options, auto simulate_world>
Verb add_world(CLI::App& simulate, const std::string& name, const std::string& description) {
  auto world = std::make_shared<SimulateWorld<Options, simulate_world>>();
  world->world = name;
  CLI::App* verb = simulate.add_subcommand(name, description);
  auto& outputs = world->flags.outputs;
  outputs.add(*verb, "-o,--output", world->output, "pose graph to write (- for stdout)", {".g2o"})
      ->required();
  outputs.add(*verb, "--ground-truth", world->ground_truth, "true poses to write, as g2o",
              {".g2o"});
  world->add_flags(*verb);
  return verb_of(verb, world);
}

}  // namespace

Verb add_simulate(CLI::App& root) {
  CLI::App* simulate = root.add_subcommand("simulate", "make data with known truth");
  return one_of(simulate,
                {add_world<CityOptions, simulate_city>(*simulate, "city",
                                                       "a robot in a grid of streets (2-D)"),
                 add_world<RingOptions, simulate_ring>(*simulate, "ring",
                                                       "a robot on laps of a circle (2-D)"),
                 add_world<SphereOptions, simulate_sphere>(*simulate, "sphere",
                                                           "a spiral over a sphere (3-D)"),
                 add_world<Grid3dOptions, simulate_grid3d>(
                     *simulate, "grid3d", "a vehicle in a grid of streets and shafts (3-D)"),
                 add_simulate_network(*simulate)});
}

}  // namespace isotherm::apps
