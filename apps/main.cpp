#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "command.hpp"
#include "console.hpp"
#include "help_formatter.hpp"
#include "interruption.hpp"
#include "isotherm/base/error.hpp"
#include "serial_openmp.hpp"
#include "suggestions.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

int failed(std::string_view problem, int code) {
  complain(problem);
  return code;
}

int run_guarded(const Verb& verb) {
  const auto [code, problem] = run_to_end(verb);
  if (!problem.empty()) complain(problem);
  if (code == kInterrupted) say_interrupted();
  return code;
}

int run(int argc, char** argv) {
  settle_streams();
  CLI::App root("Isotherm: finds and removes the edges that do not belong in a geometric graph",
                "isotherm");
  root.set_version_flag("--version", ISOTHERM_VERSION);
  root.require_subcommand(1);
  root.formatter(std::make_shared<HelpFormatter>());

  const std::vector<Verb> verbs = {add_info(root),       add_convert(root),  add_candidates(root),
                                   add_simulate(root),   add_corrupt(root),  add_densify(root),
                                   add_prune(root),      add_follow(root),   add_optimize(root),
                                   add_label(root),      add_eval(root),     add_edges(root),
                                   add_embed(root),      add_localize(root), add_report(root),
                                   add_completion(root), add_manual(root)};
  const auto words = command_words(argc, argv);
  try {
    // CLI11 takes them last first.
    root.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& error) {
    const auto meant = error.get_exit_code() == 0 ? "" : what_was_meant(root, words);
    if (!meant.empty()) return failed(meant.c_str(), kUsage);
    return root.exit(error) == 0 ? kOk : kUsage;
  } catch (const InvalidArgument& error) {
    return failed(error.what(), kUsage);
  }

  stop_cleanly_on_interrupt();
  keep_openmp_serial();
  for (const auto& verb : verbs) {
    if (verb.parser->parsed()) return run_guarded(verb);
  }
  return kUsage;
}

}  // namespace
}  // namespace isotherm::apps

int main(int argc, char** argv) { return isotherm::apps::run(argc, argv); }
