#include <memory>
#include <variant>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/base/words.hpp"
#include "isotherm/slam/evaluate/trajectory_metrics.hpp"
#include "option_verb.hpp"
#include "verbs/evaluate/trajectory_input.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;

Json errors_as_json(const ErrorStatistics& errors) {
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
    const auto any = input.read(flags);
    std::visit(
        [&](const auto& pairs) {
          const auto errors = absolute_trajectory_error(pairs, align);
          if (flags.json != "-") {
            const char* note =
                align == Alignment::first ? "  (the mean is the ATE of Datta et al., 2016)" : "";
            write_text("-",
                       fmt::format("ATE, align {}: {}{}\n", alignment, line_of(errors, "m"), note));
          }
          Json json = {{"schema", "isotherm.eval.ate/1"}, {"align", alignment}};
          json.update(errors_as_json(errors));
          write_json(flags.json, json);
        },
        any);
    return kOk;
  }
};

struct EvalRpe : OptionVerb<RelativeErrorOptions> {
  TrajectoryInput input;

  int run() {
    if (resolve_or_dump()) return kOk;
    const auto any = input.read(flags);
    std::visit(
        [&](const auto& pairs) {
          const auto errors = relative_pose_error(pairs, options);
          if (flags.json != "-") {
            write_text("-", fmt::format(
                                "RPE over {}: {}\n  rotation: {}\n", counted(options.delta, "pose"),
                                line_of(errors.translation, "m"), line_of(errors.rotation, "rad")));
          }
          Json json = {{"schema", "isotherm.eval.rpe/1"}};
          json.update(options_to_json(options));
          json.update(errors_as_json(errors.translation));
          json["rotation"] = errors_as_json(errors.rotation);
          write_json(flags.json, json);
        },
        any);
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
