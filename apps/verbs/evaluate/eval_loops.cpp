#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/slam/evaluate/evaluate_loops.hpp"
#include "isotherm/spectral/edges/verdict_file.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;

struct EvalLoops {
  CommonFlags flags;
  std::string verdicts;
  std::string labels;

  int run() const {
    const auto metrics = evaluate_loops(spectral::read_verdicts(verdicts), read_labels(labels));
    if (flags.json != "-") {
      fmt::print("precision {:.4f}  recall {:.4f}  F1 {:.4f}  AUC {:.4f}\n", metrics.precision(),
                 metrics.recall(), metrics.f1(), metrics.auc);
      fmt::print("pruned: {} incorrect, {} correct; left: {} incorrect, {} correct", metrics.tp,
                 metrics.fp, metrics.fn, metrics.tn);
      fmt::print(" ({} ambiguous); {} ignored\n", metrics.ambiguous, metrics.ignored);
    }
    write_json(flags.json, to_json(metrics));
    return kOk;
  }

  static Json to_json(const LoopMetrics& metrics) {
    return {{"schema", "isotherm.eval.loops/1"},
            {"precision", metrics.precision()},
            {"recall", metrics.recall()},
            {"f1", metrics.f1()},
            {"auc", std::isnan(metrics.auc) ? Json() : Json(metrics.auc)},
            {"tp", metrics.tp},
            {"fp", metrics.fp},
            {"fn", metrics.fn},
            {"tn", metrics.tn},
            {"ambiguous", metrics.ambiguous},
            {"ignored", metrics.ignored}};
  }
};

}  // namespace

Verb add_eval_loops(CLI::App& eval) {
  auto loops = std::make_shared<EvalLoops>();
  CLI::App* verb = eval.add_subcommand("loops", "precision and recall of verdicts");
  verb->add_option("verdicts", loops->verdicts, "verdicts written by prune")->required();
  verb->add_option("labels", loops->labels, "labels of the same edges")->required();
  add_common_flags(*verb, loops->flags);
  return {verb, [loops] { return loops->run(); }};
}

}  // namespace isotherm::apps
