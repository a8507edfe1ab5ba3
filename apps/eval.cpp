#include "verbs.hpp"

namespace isotherm::apps {

Verb add_eval(CLI::App& root) {
  CLI::App* eval = root.add_subcommand("eval", "compare results with the truth");
  eval->require_subcommand(1);
  const std::vector<Verb> kinds = {add_eval_loops(*eval), add_eval_ate(*eval), add_eval_rpe(*eval)};
  return {eval, [kinds] {
            for (const auto& kind : kinds) {
              if (kind.parser->parsed()) return kind.run();
            }
            return static_cast<int>(kUsage);
          }};
}

}  // namespace isotherm::apps
