#pragma once

#include "command.hpp"

/// Every verb adds its own parser to the root command; one file a verb.
namespace isotherm::apps {

Verb add_info(CLI::App& root);
Verb add_candidates(CLI::App& root);
Verb add_convert(CLI::App& root);
Verb add_simulate(CLI::App& root);
Verb add_simulate_network(CLI::App& simulate);
Verb add_corrupt(CLI::App& root);
Verb add_densify(CLI::App& root);
Verb add_prune(CLI::App& root);
Verb add_follow(CLI::App& root);
Verb add_optimize(CLI::App& root);
Verb add_label(CLI::App& root);
Verb add_edges(CLI::App& root);
Verb add_embed(CLI::App& root);
Verb add_localize(CLI::App& root);
Verb add_report(CLI::App& root);
Verb add_completion(CLI::App& root);
Verb add_manual(CLI::App& root);
Verb add_eval(CLI::App& root);
Verb add_eval_evidence(CLI::App& eval);
Verb add_eval_loops(CLI::App& eval);
Verb add_eval_online(CLI::App& eval);
Verb add_eval_ate(CLI::App& eval);
Verb add_eval_rpe(CLI::App& eval);
Verb add_eval_positions(CLI::App& eval);

}  // namespace isotherm::apps
