#include <memory>

#include "console.hpp"
#include "distributed/ranks.hpp"
#include "verbs/embed_output.hpp"

namespace isotherm::apps {
namespace {

using namespace spectral;

struct Options {
  EmbedOptions embed;
  distributed::SolverOptions solver;
  distributed::Partitioner partitioner = distributed::Partitioner::scotch;

  void validate() const {
    embed.validate();
    solver.validate();
  }
};

template <class Fields, class Visitor>
requires std::same_as<std::remove_const_t<Fields>, Options>
void visit_fields(Fields& options, Visitor&& visit) {
  visit_fields(options.embed, visit);
  visit_fields(options.solver, visit);
  visit("partitioner", options.partitioner, "which ranks have which vertices");
}

struct DistributedEmbed : OptionVerb<Options> {
  std::string input;
  std::string output;

  int run(const distributed::Session& session) {
    if (only_dumps(session, *this)) return kOk;
    const auto graph = read_on_ranks(session, input, flags,
                                     {.partitioner = options.partitioner, .strict = flags.strict});
    const auto result =
        distributed::embed(graph, options.embed, options.solver, progress_line(flags));
    const EmbedRun ran{options.embed, graph.vertex_count(), enum_name(result.solver)};
    warn_of_lack(flags, ran, result);
    say(flags, summary(ran, result));
    write(session, graph, result.rows);
    auto json = to_json(ran, result);
    json["options"] = options_to_json(options);
    json["inertia_count"] = result.eigen.inertia_count;
    json["graph"] = graph_json(graph);
    write_json_of(session, flags.json, json);
    return result.eigen.status == EigenStatus::converged ? kOk : kNotConverged;
  }

  void write(const distributed::Session& session, const distributed::Graph& graph,
             const Eigen::MatrixXd& rows) const {
    const bool first = session.rank() == 0;
    distributed::RankStream stream(session, output);
    if (format_suffix(output) == ".npy") {
      stream.append(first ? npy_head(graph.vertex_count(), rows.cols()) : "");
      for (Eigen::Index c = 0; c < rows.cols(); ++c) stream.append(npy_column(rows.col(c)));
    } else {
      stream.append(first ? csv_head(rows.cols()) : "");
      stream.append(csv_rows(rows, graph.ids()));
    }
    stream.commit();
  }
};

}  // namespace

Verb add_distributed_embed(CLI::App& root, const distributed::Session& session) {
  auto embed = std::make_shared<DistributedEmbed>();
  CLI::App* verb = root.add_subcommand("embed", "give the vertices of a graph coordinates");
  verb->add_option("input", embed->input, "edge list, MatrixMarket, g2o or binary graph")
      ->required();
  add_coordinates_output(*verb, embed->flags.outputs, embed->output);
  embed->add_flags(*verb);
  verb->footer(embeddings_help());
  return verb_on_ranks(verb, embed, session);
}

}  // namespace isotherm::apps
