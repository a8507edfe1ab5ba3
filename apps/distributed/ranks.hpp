#pragma once

#include <memory>
#include <string>

#include "command.hpp"
#include "isotherm/base/output_group.hpp"
#include "isotherm/spectral/distributed.hpp"
#include "option_verb.hpp"

/// The command `isotherm-mpi`: verbs that all ranks run together. Rank 0 speaks for all.
namespace isotherm::apps {

namespace distributed = spectral::distributed;

Verb add_distributed_embed(CLI::App& root, const distributed::Session& session);
Verb add_distributed_edges(CLI::App& root, const distributed::Session& session);
Verb add_distributed_prune(CLI::App& root, const distributed::Session& session);
Verb add_distributed_heat(CLI::App& root, const distributed::Session& session);

/// Brings the options of a verb into force on every rank. True if they were only to be printed,
/// which is then done. @throws what OptionVerb::resolve_or_dump() does
template <class Options>
bool only_dumps(const distributed::Session& session, OptionVerb<Options>& verb) {
  const bool dump = verb.flags.dump_config;
  session.together([&] {
    verb.flags.dump_config = dump && session.rank() == 0;
    verb.resolve_or_dump();
  });
  verb.flags.quiet = verb.flags.quiet || session.rank() > 0;
  return dump;
}

/// The verb of `parser` that runs `state` on all ranks, with outputs that appear together.
template <class State>
Verb verb_on_ranks(CLI::App* parser, const std::shared_ptr<State>& state,
                   const distributed::Session& session) {
  return {parser, [state, &session] {
            session.together([&] {
              if (session.rank() == 0) state->flags.outputs.check();
            });
            OutputGroup group;
            const int code = state->run(session);
            session.together([&] { group.commit(); });
            return code;
          }};
}

/// The graph of a file, with what there is to say of it.
distributed::Graph read_on_ranks(const distributed::Session& session, const std::string& path,
                                 const CommonFlags& flags,
                                 const distributed::GraphOptions& options);

/// What results say of the graph.
Json graph_json(const distributed::Graph& graph);

/// Writes the JSON of rank 0.
void write_json_of(const distributed::Session& session, const std::string& path, const Json& json);

}  // namespace isotherm::apps
