#include "isotherm/slam/optimize/optimize.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "console.hpp"
#include "help_formatter.hpp"
#include "isotherm/base/words.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/slam/io/trajectory_file.hpp"
#include "option_verb.hpp"
#include "verbs/input/pose_graph_input.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;

// What each kernel needs, when it is the one to take, and what it costs.
constexpr std::array<HelpChoice, 7> kKernels = {{
    {"none", "the default: least squares, for graphs that are pruned. Quickest"},
    {"huber", "large errors count by their size, not its square: tails, not false loops"},
    {"cauchy", "heavy tails: few false loops. A few more iterations"},
    {"dcs", "loops fade out by how badly they fit. Needs odometry that is nearly right"},
    {"sc", "switchable constraints: the same with a switch a loop. At the cost of dcs"},
    {"gnc",
     "truncated least squares, approached from a convex start: many false loops. Some "
     "ten optimisations"},
    {"gnc-gm", "the same with Geman and McClure's kernel, which leaves no loop out altogether"},
}};

struct OptimizeVerb : OptionVerb<OptimizeOptions> {
  std::vector<std::string> input;
  std::string output;
  std::string trusted;

  int run() {
    if (resolve_or_dump()) return kOk;
    auto file = read_input_graph(input, flags);
    return std::visit([&](auto& graph) { return run_on(graph, file); }, file.graph);
  }

  template <class Pose>
  int run_on(PoseGraph<Pose>& graph, const PoseGraphFile& file) {
    const auto roles = roles_of(graph, trusted);
    warn_of_doubts(graph, roles, flags);
    const auto result =
        optimize(graph, roles, options, {flags.threads, progress_line(flags), flags.seed});
    report(result);
    if (!output.empty()) write_poses(graph, file, result.poses);
    write_json(flags.json, to_json(result));
    return result.status == OptimizeStatus::converged ? kOk : kNotConverged;
  }

  // `graph` is the one in `file`.
  template <class Pose>
  void write_poses(PoseGraph<Pose>& graph, const PoseGraphFile& file,
                   const std::vector<Pose>& poses) const {
    const auto is_finite = [](const Pose& pose) {
      return pose.translation().allFinite() && pose.rotation_matrix().allFinite();
    };
    if (!std::all_of(poses.begin(), poses.end(), is_finite)) {
      warn(flags, fmt::format("no finite poses were found; {} is not written", output));
      return;
    }
    graph.poses = poses;
    if (format_suffix(output) == ".tum") {
      const Trajectory<Pose> trajectory{graph.poses, {}};
      warn_of_missing_times(trajectory, FileFormat::tum, flags);
      write_trajectory(output, trajectory, FileFormat::tum);
    } else {
      write_g2o(output, file);
    }
  }

  template <class Pose>
  void report(const OptimizeResult<Pose>& result) const {
    if (result.projected_information > 0) {
      warn(flags, fmt::format("{} information matrices have a negative eigenvalue, taken as zero",
                              result.projected_information));
    }
    if (result.repeats > 0) {
      warn(flags, counted(result.repeats, "edge repeats", "edges repeat") +
                      " another one to the last digit; counted once");
    }
    if (result.components > 1) {
      warn(flags, fmt::format("the graph has {} connected components, each held at one pose",
                              result.components));
    }
    const auto shown = [](double cost, int digits) {
      return std::isfinite(cost) ? fmt::format("{:.{}g}", cost, digits) : "not finite";
    };
    say(flags, fmt::format("{}: cost {} -> {} in {}, {:.2f} s", enum_name(result.status),
                           shown(result.initial_cost, 6), shown(result.final_cost, 9),
                           counted(result.iterations, "iteration"), result.seconds));
  }

  template <class Pose>
  Json to_json(const OptimizeResult<Pose>& result) const {
    return {
        {"schema", "isotherm.optimize/1"}, {"status", enum_name(result.status)},
        {"iterations", result.iterations}, {"initial_cost", result.initial_cost},
        {"final_cost", result.final_cost}, {"chi2", result.chi2.sum()},
        {"poses", result.poses.size()},    {"constraints", result.chi2.size()},
        {"components", result.components}, {"held", result.held},
        {"repeats", result.repeats},       {"projected_information", result.projected_information},
        {"seconds", result.seconds},       {"options", options_to_json(options)}};
  }
};

}  // namespace

Verb add_optimize(CLI::App& root) {
  auto optimize = std::make_shared<OptimizeVerb>();
  CLI::App* verb = root.add_subcommand("optimize", "find the poses that fit a pose graph best");
  add_graph_inputs(*verb, optimize->input, "pose graph, or several files of one (- for stdin)");
  optimize->flags.outputs.add(
      *verb, "-o,--output", optimize->output,
      "optimised pose graph (g2o; - for stdout), or trajectory if named .tum", {".g2o", ".tum"});
  verb->add_option("--trusted", optimize->trusted,
                   "CSV of edges to trust in place of odometry (edge, or from,to)")
      ->type_name("FILE");
  optimize->add_flags(*verb);
  verb->footer(help_table("Kernels:", kKernels));
  return verb_of(verb, optimize);
}

}  // namespace isotherm::apps
