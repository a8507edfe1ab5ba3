#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/base/statistics.hpp"
#include "isotherm/base/words.hpp"
#include "isotherm/slam/evaluate/evaluate_online.hpp"
#include "option_verb.hpp"
#include "verbs/evaluate/event_log.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;

struct EvalOnline : OptionVerb<NoOptions> {
  std::string events;
  std::string labels;
  std::string steps;
  bool even_odds = false;

  int run() {
    if (resolve_or_dump()) return kOk;
    auto log = read_event_log(events);
    if (even_odds) log.verdicts = decided_at_even_odds(std::move(log.verdicts));
    const auto metrics = evaluate_online(log.verdicts, read_labels(labels), log.edges);
    if (flags.json != "-" && steps != "-") write_text("-", to_text(metrics, log));
    if (!steps.empty()) write_text(steps, to_csv(metrics, log));
    write_json(flags.json, to_json(metrics, log));
    return kOk;
  }

 private:
  static double delay(const OnlineMetrics& metrics, double share) {
    if (metrics.delays.empty()) return 0.0;
    if (share == 1.0) return static_cast<double>(metrics.delays.back());
    return quantile({metrics.delays.begin(), metrics.delays.end()}, share);
  }

  // The mean over all steps (iATE).
  static std::optional<double> mean_error(const EventLog& log) {
    if (log.errors.empty()) return std::nullopt;
    double sum = 0.0;
    for (const auto& error : log.errors) sum += error.ate;
    return sum / static_cast<double>(log.errors.size());
  }

  static OnlineStep last_step(const OnlineMetrics& metrics) {
    return metrics.steps.empty() ? OnlineStep{} : metrics.steps.back();
  }

  static std::string to_text(const OnlineMetrics& metrics, const EventLog& log) {
    const auto last = last_step(metrics);
    std::string text = fmt::format(
        "on the way: precision {:.4f}  recall {:.4f}; at the end: precision {:.4f}  recall {:.4f}  "
        "(a positive is a kept loop)\n",
        metrics.mean_precision, metrics.mean_recall, last.precision(), last.recall());
    text += fmt::format(
        "{} right at the end, {} wrong, {} ambiguous; {} without a label\n"
        "poses until a right verdict stays: median {:.0f}, nine of ten {:.0f}, worst {:.0f}\n",
        counted(static_cast<std::uint64_t>(metrics.right), "loop"), metrics.wrong,
        metrics.undecided, metrics.ignored, delay(metrics, 0.5), delay(metrics, 0.9),
        delay(metrics, 1.0));
    if (const auto mean = mean_error(log)) {
      text += fmt::format("ATE: mean over {} {:.4f} m (iATE), at the end {:.4f} m\n",
                          counted(log.errors.size(), "step"), *mean, log.errors.back().ate);
    }
    return text;
  }

  static Json to_json(const OnlineMetrics& metrics, const EventLog& log) {
    const auto last = last_step(metrics);
    const auto mean = mean_error(log);
    return {{"schema", "isotherm.eval.online/1"},
            {"mean_precision", metrics.mean_precision},
            {"mean_recall", metrics.mean_recall},
            {"precision", last.precision()},
            {"recall", last.recall()},
            {"right", metrics.right},
            {"wrong", metrics.wrong},
            {"ambiguous", metrics.undecided},
            {"ignored", metrics.ignored},
            {"delay_poses",
             {{"median", delay(metrics, 0.5)},
              {"p90", delay(metrics, 0.9)},
              {"worst", delay(metrics, 1.0)}}},
            {"iate_m", mean ? Json(*mean) : Json()},
            {"ate_m", mean ? Json(log.errors.back().ate) : Json()},
            {"error_steps", log.errors.size()}};
  }

  // A row a change and a row an error, in order of time; what a row does not change is as before.
  static std::string to_csv(const OnlineMetrics& metrics, const EventLog& log) {
    std::string text = "at,poses,kept_true,kept_false,missed,precision,recall,ate\n";
    OnlineStep now;
    auto error = log.errors.begin();
    const auto add_errors_before = [&](std::int64_t at) {
      for (; error != log.errors.end() && error->at < at; ++error) {
        now.at = error->at;
        now.poses = error->poses;
        text += row(now, fmt::format("{}", error->ate));
      }
    };
    for (const auto& step : metrics.steps) {
      add_errors_before(step.at);
      now = step;
      text += row(now, "");
    }
    add_errors_before(log.edges + 1);
    return text;
  }

  static std::string row(const OnlineStep& step, const std::string& ate) {
    return fmt::format("{},{},{},{},{},{:.6f},{:.6f},{}\n", step.at, step.poses, step.kept_true,
                       step.kept_false, step.missed, step.precision(), step.recall(), ate);
  }
};

}  // namespace

Verb add_eval_online(CLI::App& eval) {
  auto online = std::make_shared<EvalOnline>();
  CLI::App* verb = eval.add_subcommand(
      "online", "precision, recall and error through time; a positive is a kept loop");
  verb->add_option("events", online->events, "events written by follow (- for stdin)")->required();
  verb->add_option("labels", online->labels, "labels of the edges it followed")->required();
  verb->add_flag("--even-odds", online->even_odds,
                 "leave none ambiguous: what is likelier true than false counts as kept, "
                 "the rest as pruned");
  online->flags.outputs.add(*verb, "--steps", online->steps,
                            "how things stood from each change on, as CSV (- for stdout)",
                            {".csv"});
  online->add_flags(*verb);
  return verb_of(verb, online);
}

}  // namespace isotherm::apps
