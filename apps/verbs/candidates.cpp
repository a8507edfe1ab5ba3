#include <memory>
#include <variant>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/base/words.hpp"
#include "isotherm/slam/io/candidate_list.hpp"
#include "isotherm/slam/io/file_format.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/slam/io/trajectory_file.hpp"
#include "option_verb.hpp"
#include "verbs/input/pose_graph_input.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;

// Pairs of place recognition, and how odometry from a trajectory is trusted.
struct CandidateOptions : PlaceOptions {
  double odometry_sigma = 0.05;        // metres a step
  double odometry_turn_sigma = 0.005;  // radians a step

  void validate() const { require_fields_in_range(*this); }
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, CandidateOptions>
void visit_fields(Options& options, Visitor&& visit) {
  using Base = std::conditional_t<std::is_const_v<Options>, const PlaceOptions, PlaceOptions>;
  visit_fields(static_cast<Base&>(options), visit);
  visit("odometry_sigma", options.odometry_sigma,
        "metres a step of odometry that comes as a trajectory", closed(1e-9, 1e6));
  visit("odometry_turn_sigma", options.odometry_turn_sigma, "radians a step of it",
        closed(1e-9, 10));
}

struct CandidatesVerb : OptionVerb<CandidateOptions> {
  std::string list;
  std::string odometry;
  std::string output;

  int run() {
    if (resolve_or_dump()) return kOk;
    auto graph = read_odometry();
    const auto pairs = read_place_pairs(list);
    std::visit([&](auto& own) { add(own, pairs); }, graph);
    return kOk;
  }

  template <class Pose>
  void add(PoseGraph<Pose>& graph, const std::vector<PlacePair>& pairs) const {
    const auto steps = graph.constraints.size();
    const auto left_out = add_place_pairs(graph, pairs, options, list);
    const auto loops = graph.constraints.size() - steps;
    write_g2o(output, graph);
    say(flags, fmt::format("{}, {} of odometry, {} ({} left out: too near or not among the best)",
                           counted(graph.ids.size(), "pose"), counted(steps, "edge"),
                           counted(loops, "candidate"), left_out));
    write_json(flags.json, {{"schema", "isotherm.candidates/1"},
                            {"poses", graph.ids.size()},
                            {"odometry", steps},
                            {"candidates", loops},
                            {"left_out", left_out},
                            {"options", options_to_json(options)}});
  }

 private:
  // The odometry of a pose graph, without its loops, or the steps of a trajectory.
  AnyPoseGraph read_odometry() const {
    TextReader reader(odometry);
    const auto format = require_format(reader);
    const ReadOptions reading{.strict = flags.strict};
    if (content_of(format) == FileContent::trajectory) {
      const auto file = read_trajectory(reader, format, reading);
      warn_of(file.report, flags);
      return std::visit([this](const auto& path) -> AnyPoseGraph { return steps_of(path); },
                        file.trajectory);
    }
    auto file = read_pose_graph(reader, format, reading);
    warn_of(file.report, flags);
    return std::visit(
        [](const auto& graph) -> AnyPoseGraph {
          std::vector<bool> keep(graph.constraints.size(), false);
          for (const Index k : edge_roles(graph).odometry) keep[k] = true;
          return filter_constraints(graph, keep);
        },
        file.graph);
  }

  template <class Pose>
  PoseGraph<Pose> steps_of(const Trajectory<Pose>& path) const {
    typename Pose::Tangent deviations;
    deviations.template head<Pose::kDim>().setConstant(options.odometry_sigma);
    deviations.template tail<Pose::kDof - Pose::kDim>().setConstant(options.odometry_turn_sigma);
    PoseGraph<Pose> graph;
    graph.poses = path.poses;
    for (Index k = 0; k < static_cast<Index>(path.poses.size()); ++k) {
      graph.ids.push_back(static_cast<VertexId>(k));
      if (k == 0) continue;
      Constraint<Pose> step;
      step.from = k - 1;
      step.to = k;
      step.T_from_to = path.poses[k - 1].inverse() * path.poses[k];
      step.information = deviations.cwiseInverse().cwiseAbs2().asDiagonal();
      graph.constraints.push_back(step);
    }
    return graph;
  }
};

}  // namespace

Verb add_candidates(CLI::App& root) {
  auto candidates = std::make_shared<CandidatesVerb>();
  CLI::App* verb = root.add_subcommand(
      "candidates", "make a pose graph of what place recognition gives, for prune to judge");
  verb->add_option("list", candidates->list,
                   "rows of a pose and those that look like it, best first, or columns "
                   "from,to[,x,y,theta or x,y,z,qx,qy,qz,qw] (- for stdin)")
      ->required();
  verb->add_option("--odometry", candidates->odometry,
                   "pose graph, or trajectory in any format, whose pose k has the number k")
      ->required()
      ->type_name("FILE");
  candidates->flags.outputs
      .add(*verb, "-o,--output", candidates->output, "pose graph to write (- for stdout)", {".g2o"})
      ->required();
  candidates->add_flags(*verb);
  return verb_of(verb, candidates);
}

}  // namespace isotherm::apps
