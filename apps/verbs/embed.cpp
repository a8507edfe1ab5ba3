#include <memory>

#include "console.hpp"
#include "isotherm/spectral/eigen/embed.hpp"
#include "isotherm/spectral/graph/graph_file.hpp"
#include "option_verb.hpp"
#include "verbs/embed_output.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace spectral;

struct EmbedVerb : OptionVerb<EmbedOptions> {
  std::string input;
  std::string output;

  int run() {
    if (resolve_or_dump()) return kOk;
    auto file = read_graph(input, {.strict = flags.strict});
    merge_directions(file, {.strict = flags.strict});
    for (const auto& diagnostic : file.report.diagnostics) warn(flags, to_string(diagnostic));
    const auto result = embed(file.graph, options, progress_line(flags));
    const auto& eigen = result.eigen;
    const EmbedRun ran{options, eigen.size(), enum_name(eigen.method)};
    warn_of_lack(flags, ran, result);
    say(flags, summary(ran, result));
    write_text(output, format_suffix(output) == ".npy"
                           ? npy_head(eigen.size(), result.rows.cols()) + npy_column(result.rows)
                           : csv_head(result.rows.cols()) + csv_rows(result.rows, file.ids));
    write_json(flags.json, to_json(ran, result));
    return eigen.status == EigenStatus::converged ? kOk : kNotConverged;
  }
};

}  // namespace

Verb add_embed(CLI::App& root) {
  auto embed = std::make_shared<EmbedVerb>();
  CLI::App* verb = root.add_subcommand("embed", "give the vertices of a graph coordinates");
  verb->add_option("input", embed->input, "edge list or MatrixMarket file (- for stdin)")
      ->required();
  add_coordinates_output(*verb, embed->flags.outputs, embed->output);
  embed->add_flags(*verb);
  verb->footer(embeddings_help());
  return verb_of(verb, embed);
}

}  // namespace isotherm::apps
