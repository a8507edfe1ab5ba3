#include <memory>
#include <vector>

#include <fmt/format.h>

#include "console.hpp"
#include "distributed/ranks.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/base/words.hpp"
#include "isotherm/spectral/graph/graph_file.hpp"
#include "isotherm/spectral/heat/heat_scales.hpp"

namespace isotherm::apps {
namespace {

using namespace spectral;

struct HeatOptions {
  std::vector<double> scales;
  double tolerance = 1e-6;
  int max_steps = 1000;
  distributed::Partitioner partitioner = distributed::Partitioner::scotch;

  void validate() const { require_fields_in_range(*this); }
};

template <class Fields, class Visitor>
requires std::same_as<std::remove_const_t<Fields>, HeatOptions>
void visit_fields(Fields& options, Visitor&& visit) {
  visit("scales", options.scales, "diffusion times; none: by the graph", or_none(closed(0, 1e12)));
  visit("tolerance", options.tolerance, "largest width of a heat distance's bracket",
        left_open(0, 2));
  visit("max_steps", options.max_steps, "most Lanczos steps a pair", closed(1, 1e6));
  visit("partitioner", options.partitioner, "which ranks have which vertices");
}

struct DistributedHeat : OptionVerb<HeatOptions> {
  std::string input;
  std::string pairs;
  std::string output;

  int run(const distributed::Session& session) {
    if (only_dumps(session, *this)) return kOk;
    const auto graph = read_on_ranks(session, input, flags,
                                     {.partitioner = options.partitioner, .strict = flags.strict});
    const auto asked = pairs.empty() ? edges_of(graph) : read_pairs(session, graph);
    const auto progress = progress_line(flags);
    const auto scales = options.scales.empty() ? scales_of(graph, progress) : options.scales;
    const auto result = distributed::heat_distances(
        graph, asked, scales,
        {.tolerance = options.tolerance, .max_steps = options.max_steps, .progress = progress});
    write(session, graph, result);
    report(session, graph, result);
    return result.converged() ? kOk : kNotConverged;
  }

  static std::vector<VertexPair> edges_of(const distributed::Graph& graph) {
    std::vector<VertexPair> all;
    for (const auto& edge : graph.edges()) all.push_back({edge.from, edge.to});
    return all;
  }

  // Rank 0 reads and asks for all of them: they are few beside the graph.
  std::vector<VertexPair> read_pairs(const distributed::Session& session,
                                     const distributed::Graph& graph) const {
    std::vector<std::uint64_t> ends;
    session.together([&] {
      if (session.rank() > 0) return;
      const auto file = read_graph(pairs, {.strict = flags.strict});
      for (const auto& edge : file.graph.edges()) {
        ends.insert(ends.end(), {file.ids[edge.from], file.ids[edge.to]});
      }
    });
    const auto found = graph.positions_of(ends);
    std::vector<VertexPair> asked;
    for (std::size_t k = 0; k < found.size(); k += 2) asked.push_back({found[k], found[k + 1]});
    return asked;
  }

  static std::vector<double> scales_of(const distributed::Graph& graph,
                                       const ProgressCallback& progress) {
    EigenOptions smallest;
    smallest.count = 1;
    smallest.null_vectors = false;
    smallest.tolerance = 1e-6;
    smallest.check_inertia = false;
    smallest.progress = progress;
    const auto eigen =
        distributed::smallest_eigenpairs(graph, LaplacianKind::combinatorial, smallest);
    return automatic_scales(eigen.count() > 0 ? eigen.values[0] : 0.0);
  }

  void write(const distributed::Session& session, const distributed::Graph& graph,
             const HeatDistanceResult& result) const {
    std::vector<Index> ends;
    for (const auto& pair : result.pairs) ends.insert(ends.end(), {pair.from, pair.to});
    const auto ids = graph.ids_of(ends);
    distributed::RankStream stream(session, output);
    stream.append(session.rank() == 0 ? "from,to,scale,distance,lower,upper\n" : "");
    std::string text;
    for (std::size_t k = 0; k < result.pairs.size(); ++k) {
      for (std::size_t s = 0; s < result.scales.size(); ++s) {
        const auto& value = result.at(k, s);
        text += fmt::format("{},{}", ids[2 * k], ids[2 * k + 1]);
        for (const double number : {result.scales[s], value.value, value.lower, value.upper}) {
          text += ',';
          append_number(text, number);
        }
        text += '\n';
      }
    }
    stream.append(text);
    stream.commit();
  }

  void report(const distributed::Session& session, const distributed::Graph& graph,
              const HeatDistanceResult& result) const {
    const auto asked = pairs.empty() ? static_cast<std::uint64_t>(graph.edge_count())
                                     : static_cast<std::uint64_t>(result.pairs.size());
    say(flags,
        fmt::format("{}, {}, brackets at most {:.1e} wide, {:.2f} s{}", counted(asked, "pair"),
                    counted(result.scales.size(), "scale"), result.widest, result.seconds,
                    result.converged() ? "" : "; not converged"));
    if (result.imprecise > 0) {
      const auto values = static_cast<std::int64_t>(asked * result.scales.size());
      warn(flags, words_of_imprecise(result.imprecise, values, "heat distances"));
    }
    write_json_of(session, flags.json,
                  {{"schema", "isotherm.heat/1"},
                   {"pairs", asked},
                   {"scales", result.scales},
                   {"widest", result.widest},
                   {"unconverged", result.unconverged},
                   {"imprecise", result.imprecise},
                   {"seconds", result.seconds},
                   {"options", options_to_json(options)},
                   {"graph", graph_json(graph)}});
  }
};

}  // namespace

Verb add_distributed_heat(CLI::App& root, const distributed::Session& session) {
  auto heat = std::make_shared<DistributedHeat>();
  CLI::App* verb = root.add_subcommand("heat", "heat distances of pairs, with proven bounds");
  verb->add_option("input", heat->input, "edge list, MatrixMarket, g2o or binary graph")
      ->required();
  verb->add_option("--pairs", heat->pairs, "pairs (from,to) to compute; none: every edge")
      ->type_name("FILE");
  heat->flags.outputs
      .add(*verb, "-o,--output", heat->output, "distances to write, as CSV (- for stdout)",
           {".csv"})
      ->required();
  heat->add_flags(*verb);
  return verb_on_ranks(verb, heat, session);
}

}  // namespace isotherm::apps
