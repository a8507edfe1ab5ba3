#include <memory>
#include <variant>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/slam/evaluate/ground_truth.hpp"
#include "isotherm/slam/evaluate/trajectory_metrics.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/slam/io/trajectory_file.hpp"
#include "option_verb.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;

// Where the two trajectories come from; shared by ate and rpe.
struct TrajectoryInput {
  std::string estimate;
  std::string truth;
  std::string timestamps;
  double max_gap = 0.0;

  void add_to(CLI::App& verb) {
    verb.add_option("estimate", estimate, "pose graph or trajectory to judge")->required();
    verb.add_option("ground-truth", truth, "pose graph or trajectory taken as true")->required();
    verb.add_option("--timestamps", timestamps,
                    "time of each estimated pose in seconds, one a line: the truth is then "
                    "interpolated at these times")
        ->type_name("FILE");
    add_number(verb, "--max-gap", max_gap,
               "seconds to the nearest true pose beyond which there is none; 0: any with "
               "--timestamps, else 0.01",
               closed(0, 1e9))
        ->default_str("0");
  }

  // Calls use(pairs) with poses of the right dimension.
  template <class Use>
  void read(const CommonFlags& flags, Use use) const {
    const bool by_vertex = is_pose_graph(estimate) && (is_pose_graph(truth) || !timestamps.empty());
    if (by_vertex) {
      const auto file = read_pose_graph(estimate, {.strict = flags.strict});
      std::visit([&](const auto& graph) { use(pairs_by_vertex(graph)); }, file.graph);
      return;
    }
    if (!timestamps.empty()) {
      throw InvalidArgument("timestamps", "are for an estimate that is a pose graph");
    }
    const auto estimated = read_trajectory(estimate, {.strict = flags.strict}).trajectory;
    const auto expected = read_trajectory(truth, {.strict = flags.strict}).trajectory;
    std::visit([&](const auto& a, const auto& b) { use(pairs_by_time(a, b)); }, estimated,
               expected);
  }

 private:
  static bool is_pose_graph(const std::string& path) {
    TextReader reader(path);
    return content_of(detect_format(reader)) == FileContent::pose_graph;
  }

  template <class Pose>
  PosePairs<Pose> pairs_by_vertex(const PoseGraph<Pose>& graph) const {
    const auto true_poses = read_ground_truth(graph, {truth, timestamps, max_gap});
    return pair_poses(trajectory_of(graph).poses, true_poses);
  }

  template <class Pose>
  PosePairs<Pose> pairs_by_time(const Trajectory<Pose>& estimated,
                                const Trajectory<Pose>& expected) const {
    return pair_trajectories(estimated, expected, max_gap > 0.0 ? max_gap : 0.01);
  }
  PosePairs<Pose3> pairs_by_time(const Trajectory<Pose2>& estimated,
                                 const Trajectory<Pose3>& expected) const {
    return pairs_by_time(lift(estimated), expected);
  }
  PosePairs<Pose3> pairs_by_time(const Trajectory<Pose3>& estimated,
                                 const Trajectory<Pose2>& expected) const {
    return pairs_by_time(estimated, lift(expected));
  }
};

Json to_json(const ErrorStatistics& errors) {
  return {{"mean", errors.mean},  {"rmse", errors.rmse}, {"median", errors.median},
          {"max", errors.max},    {"min", errors.min},   {"std", errors.std},
          {"pairs", errors.pairs}};
}

std::string line_of(const ErrorStatistics& errors, const char* unit) {
  return fmt::format("mean {:.4f}  RMSE {:.4f}  median {:.4f}  max {:.4f} {}  ({} pairs)",
                     errors.mean, errors.rmse, errors.median, errors.max, unit, errors.pairs);
}

struct EvalAte : OptionVerb<NoOptions> {
  TrajectoryInput input;
  std::string alignment = "se";

  int run() {
    if (resolve_or_dump()) return kOk;
    const auto align = enum_value<Alignment>("align", alignment);
    input.read(flags, [&](const auto& pairs) {
      const auto errors = absolute_trajectory_error(pairs, align);
      if (flags.json != "-") {
        // The heat-kernel paper's ATE is the mean after aligning the first pose.
        const char* note = align == Alignment::first ? "  (mean: the paper's ATE)" : "";
        write_text("-",
                   fmt::format("ATE, align {}: {}{}\n", alignment, line_of(errors, "m"), note));
      }
      Json json = {{"schema", "isotherm.eval.ate/1"}, {"align", alignment}};
      json.update(to_json(errors));
      write_json(flags.json, json);
    });
    return kOk;
  }
};

struct EvalRpe : OptionVerb<RelativeErrorOptions> {
  TrajectoryInput input;

  int run() {
    if (resolve_or_dump()) return kOk;
    input.read(flags, [&](const auto& pairs) {
      const auto errors = relative_pose_error(pairs, options);
      if (flags.json != "-") {
        write_text("-",
                   fmt::format("RPE over {} poses: {}\n  rotation: {}\n", options.delta,
                               line_of(errors.translation, "m"), line_of(errors.rotation, "rad")));
      }
      Json json = {{"schema", "isotherm.eval.rpe/1"}};
      json.update(options_to_json(options));
      json.update(to_json(errors.translation));
      json["rotation"] = to_json(errors.rotation);
      write_json(flags.json, json);
    });
    return kOk;
  }
};

}  // namespace

Verb add_eval_ate(CLI::App& eval) {
  auto ate = std::make_shared<EvalAte>();
  CLI::App* verb = eval.add_subcommand("ate", "absolute trajectory error");
  ate->input.add_to(*verb);
  verb->add_option("--align", ate->alignment,
                   "first pose, least squares in SE(2) or SE(3), or none")
      ->check(CLI::IsMember({"first", "se", "none"}))
      ->capture_default_str();
  ate->add_flags(*verb);
  return verb_of(verb, ate);
}

Verb add_eval_rpe(CLI::App& eval) {
  auto rpe = std::make_shared<EvalRpe>();
  CLI::App* verb = eval.add_subcommand("rpe", "relative pose error");
  rpe->input.add_to(*verb);
  rpe->add_flags(*verb);
  return verb_of(verb, rpe);
}

}  // namespace isotherm::apps
