#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "console.hpp"
#include "isotherm/slam/evaluate/evaluate_loops.hpp"
#include "isotherm/spectral/edges/verdict_file.hpp"
#include "option_verb.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;

struct EvalLoops : OptionVerb<NoOptions> {
  std::string verdicts;
  std::string labels;

  int run() {
    if (resolve_or_dump()) return kOk;
    const auto metrics = evaluate_loops(spectral::read_verdicts(verdicts), read_labels(labels));
    if (flags.json != "-") {
      write_text("-", to_text(metrics));
    }
    write_json(flags.json, to_json(metrics));
    return kOk;
  }

  static std::string to_text(const LoopMetrics& metrics) {
    return fmt::format(
               "precision {:.4f}  recall {:.4f}  F1 {:.4f}  AUC {:.4f}  "
               "(a positive is a pruned loop)\n",
               metrics.precision(), metrics.recall(), metrics.f1(), metrics.auc) +
           fmt::format("pruned: {} incorrect, {} correct; left: {} incorrect, {} correct",
                       metrics.tp, metrics.fp, metrics.fn, metrics.tn) +
           fmt::format(" ({} ambiguous); {} ignored\n", metrics.ambiguous, metrics.ignored);
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
  CLI::App* verb =
      eval.add_subcommand("loops", "precision and recall of verdicts; a positive is a pruned loop");
  verb->add_option("verdicts", loops->verdicts, "verdicts written by prune")->required();
  verb->add_option("labels", loops->labels, "labels of the same edges")->required();
  loops->add_flags(*verb);
  return verb_of(verb, loops);
}

}  // namespace isotherm::apps
