#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "option_flags.hpp"
#include "output_flags.hpp"

namespace isotherm::apps {

/// What the process returns; part of the command's contract.
enum ExitCode : int {
  kOk = 0,
  kFailure = 1,        ///< internal or numerical failure
  kUsage = 2,          ///< unknown flag, missing argument, option out of range
  kBadInput = 3,       ///< a file that cannot be read, understood or written
  kNotConverged = 4,   ///< finished, but the iteration did not converge
  kInterrupted = 130,  ///< stopped by Ctrl-C or SIGTERM; nothing was written
};

/// One verb of the command: its parser and what runs when it was chosen.
struct Verb {
  CLI::App* parser = nullptr;
  std::function<int()> run;
};

/// The verb `parent` that runs whichever of its subcommands was chosen.
Verb one_of(CLI::App* parent, std::vector<Verb> subcommands);

/// Flags every verb understands.
struct CommonFlags {
  std::string json;    ///< path of the JSON result, "-" for stdout, "" for none
  std::string config;  ///< path of a JSON file with option values
  bool dump_config = false;
  bool strict = false;
  bool quiet = false;
  bool verbose = false;
  bool no_progress = false;
  std::uint64_t seed = 0;
  int threads = 0;      ///< 0: as many as the machine has cores
  OutputFlags outputs;  ///< every file that the verb writes
};

void add_common_flags(CLI::App& verb, CommonFlags& flags);

/// Checks the outputs that `flags` name, runs, and lets the outputs appear together.
/// @throws what check() and `run` throw
int run_with_outputs(const CommonFlags& flags, const std::function<int()>& run);

/// The verb of `parser` that runs `state`, which has `flags` and run().
template <class State>
Verb verb_of(CLI::App* parser, const std::shared_ptr<State>& state) {
  return {parser,
          [state] { return run_with_outputs(state->flags, [&state] { return state->run(); }); }};
}

/// How a run ended: what the process returns, and what there is to say of it.
struct Ending {
  int code = kOk;
  std::string problem;  ///< empty if there is none, or the run was interrupted
};

/// Runs, and turns what is thrown into the exit codes of the contract.
Ending run_to_end(const Verb& verb);

/// The configuration named by --config, or an empty object.
/// @throws FileError, ParseError
Json read_config(const CommonFlags& flags);

/// Writes `text` to `path` ("-" is stdout). @throws FileError
void write_text(const std::string& path, std::string_view text);

/// Pretty-prints `json` to `path` ("-" is stdout); does nothing for an empty path. What
/// is not UTF-8, as names in files need not be, becomes U+FFFD.
void write_json(const std::string& path, const Json& json);

}  // namespace isotherm::apps
