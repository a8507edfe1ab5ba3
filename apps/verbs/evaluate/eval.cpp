#include "verbs/verbs.hpp"

namespace isotherm::apps {

Verb add_eval(CLI::App& root) {
  CLI::App* eval = root.add_subcommand("eval", "compare results with the truth");
  return one_of(eval, {add_eval_loops(*eval), add_eval_online(*eval), add_eval_evidence(*eval),
                       add_eval_ate(*eval), add_eval_rpe(*eval), add_eval_positions(*eval)});
}

}  // namespace isotherm::apps
