#include "isotherm/slam/simulate.hpp"

#include <memory>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "option_verb.hpp"
#include "verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;

struct SimulateCity : OptionVerb<CityOptions> {
  std::string output;
  std::string ground_truth;

  int run() {
    if (resolve_or_dump()) return kOk;
    options.seed = flags.seed;
    const auto city = simulate_city(options);
    const auto roles = edge_roles(city.graph);
    write_g2o(output, city.graph);
    if (!ground_truth.empty()) {
      PoseGraph<Pose2> truth;
      truth.ids = city.graph.ids;
      truth.poses = city.truth;
      write_g2o(ground_truth, truth);
    }
    const double drift =
        (city.graph.poses.back().translation() - city.truth.back().translation()).norm();
    say(flags,
        fmt::format("city: {} poses, {} odometry edges, {} loops, odometry ends {:.2f} m off",
                    city.graph.vertex_count(), roles.odometry.size(), roles.candidates.size(),
                    drift));
    write_json(flags.json, {{"schema", "isotherm.simulate/1"},
                            {"world", "city"},
                            {"poses", city.graph.vertex_count()},
                            {"odometry", roles.odometry.size()},
                            {"loops", roles.candidates.size()},
                            {"drift_m", drift},
                            {"options", options_to_json(options)}});
    return kOk;
  }
};

}  // namespace

Verb add_simulate(CLI::App& root) {
  CLI::App* simulate = root.add_subcommand("simulate", "make a pose graph with known truth");
  simulate->require_subcommand(1);
  auto city = std::make_shared<SimulateCity>();
  CLI::App* verb = simulate->add_subcommand("city", "a robot in a grid of streets (2-D)");
  verb->add_option("-o,--output", city->output, "pose graph to write (- for stdout)")
      ->required()
      ->type_name("FILE");
  verb->add_option("--ground-truth", city->ground_truth, "true poses to write, as g2o")
      ->type_name("FILE");
  city->add_flags(*verb);
  return {simulate, [city] { return city->run(); }};
}

}  // namespace isotherm::apps
