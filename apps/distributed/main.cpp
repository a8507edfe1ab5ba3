#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "console.hpp"
#include "distributed/ranks.hpp"
#include "help_formatter.hpp"
#include "interruption.hpp"
#include "isotherm/base/error.hpp"
#include "suggestions.hpp"

namespace isotherm::apps {
namespace {

Ending run_chosen(const std::vector<Verb>& verbs) {
  for (const auto& verb : verbs) {
    if (verb.parser->parsed()) return run_to_end(verb);
  }
  return {kUsage, ""};
}

Ending run_on_rank(const distributed::Session& session, int argc, char** argv) {
  CLI::App root("Isotherm on several machines: started as mpirun -n RANKS isotherm-mpi VERB ...",
                "isotherm-mpi");
  root.set_version_flag("--version", ISOTHERM_VERSION);
  root.require_subcommand(1);
  root.formatter(std::make_shared<HelpFormatter>());
  const std::vector<Verb> verbs = {
      add_distributed_embed(root, session), add_distributed_edges(root, session),
      add_distributed_prune(root, session), add_distributed_heat(root, session)};
  const auto words = command_words(argc, argv);
  try {
    // CLI11 takes them last first.
    root.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& error) {
    const auto meant = error.get_exit_code() == 0 ? "" : what_was_meant(root, words);
    if (!meant.empty()) return {kUsage, meant};
    if (session.rank() == 0) root.exit(error);
    return {error.get_exit_code() == 0 ? kOk : kUsage, ""};
  } catch (const InvalidArgument& error) {
    return {kUsage, error.what()};
  }
  stop_cleanly_on_interrupt();
  if (session.rank() > 0) leave_interruption_unsaid();
  return run_chosen(verbs);
}

int run(int argc, char** argv) {
  settle_streams();
  const distributed::Session session;
  const auto [code, problem] = run_on_rank(session, argc, argv);
  const int worst = session.agree_on_end(code, problem, [](std::string_view text) {
    if (!text.empty()) complain(text);
  });
  if (worst == kInterrupted) say_interrupted();
  return worst;
}

}  // namespace
}  // namespace isotherm::apps

int main(int argc, char** argv) { return isotherm::apps::run(argc, argv); }
