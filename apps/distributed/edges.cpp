#include <algorithm>
#include <chrono>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "console.hpp"
#include "distributed/ranks.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/base/words.hpp"
#include "isotherm/spectral/edges/edge_verdicts.hpp"
#include "isotherm/spectral/edges/judge_edges.hpp"
#include "isotherm/spectral/graph/graph_file.hpp"

namespace isotherm::apps {
namespace {

using namespace spectral;

struct EdgesOptions {
  std::vector<double> scales;
  std::vector<double> konst = {kDefaultKonst};  // as on one machine
  double tolerance = 1e-9;
  distributed::Partitioner partitioner = distributed::Partitioner::scotch;

  void validate() const { require_fields_in_range(*this); }
};

template <class Fields, class Visitor>
requires std::same_as<std::remove_const_t<Fields>, EdgesOptions>
void visit_fields(Fields& options, Visitor&& visit) {
  visit("scales", options.scales, "diffusion times, descending; none: by the graph",
        or_none(closed(0, 1e12)));
  visit("konst", options.konst, "deviations above the mean, one or one a scale", closed(-1e6, 1e6));
  visit("tolerance", options.tolerance, "error allowed in heat", left_open(0, 1));
  visit("partitioner", options.partitioner, "which ranks have which vertices");
}

/// What was decided about this rank's edges.
struct Judged {
  std::vector<distributed::FileOrderEdge> edges;
  std::vector<std::uint64_t> ids;  // of their ends, two an edge
  EdgeVerdicts verdicts;
};

struct DistributedEdges : OptionVerb<EdgesOptions> {
  std::string input;
  std::string output;
  std::string verdicts;
  std::string trusted;
  bool drop_ambiguous = false;

  int run(const distributed::Session& session) {
    if (only_dumps(session, *this)) return kOk;
    const auto start = std::chrono::steady_clock::now();
    const auto graph = read_on_ranks(session, input, flags,
                                     {.partitioner = options.partitioner, .strict = flags.strict});
    Judged judged = name(graph);
    judge(session, graph, judged);
    if (!output.empty()) write_kept(session, judged);
    if (!verdicts.empty()) write_verdicts_of(session, judged);
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    report(session, graph, judged, passed.count());
    return kOk;
  }

  static Judged name(const distributed::Graph& graph) {
    Judged judged;
    judged.edges = graph.edges();
    std::vector<Index> ends;
    for (const auto& edge : judged.edges) ends.insert(ends.end(), {edge.from, edge.to});
    judged.ids = graph.ids_of(ends);
    return judged;
  }

  // As one machine does: bridges, self-loops and trusted edges are no candidates.
  void judge(const distributed::Session& session, const distributed::Graph& graph,
             Judged& judged) const {
    const auto bridge = distributed::find_bridges(graph);
    const auto known = trusted_edges(session, judged);
    std::vector<bool> candidate;
    for (std::size_t k = 0; k < judged.edges.size(); ++k) {
      const bool loop = judged.edges[k].from == judged.edges[k].to;
      candidate.push_back(!bridge[k] && !loop && !known[k]);
    }
    const auto heat = distributed::multiscale_heat(
        graph, candidate,
        {.scales = options.scales, .konst = options.konst, .tolerance = options.tolerance},
        {.progress = progress_line(flags)});
    for (std::size_t k = 0; k < judged.edges.size(); ++k) {
      const bool loop = judged.edges[k].from == judged.edges[k].to;
      EdgeVerdict verdict{judged.edges[k].number, judged.ids[2 * k], judged.ids[2 * k + 1]};
      verdict.threshold = 1.0;
      verdict.stage = loop ? "self-loop" : "trusted";
      if (bridge[k]) {
        verdict.verdict = Verdict::ambiguous;
        verdict.stage = "bridge";
      } else if (candidate[k]) {
        verdict.verdict = heat.verdicts[k].pruned ? Verdict::prune : Verdict::keep;
        verdict.score = heat.verdicts[k].score;
        verdict.stage = heat.verdicts[k].stage;
      }
      judged.verdicts.push_back(std::move(verdict));
    }
  }

  // Those that the file of trusted edges has, in either direction. Every rank reads it: it is
  // small beside the graph.
  std::vector<bool> trusted_edges(const distributed::Session& session, const Judged& judged) const {
    std::vector<bool> known(judged.edges.size(), false);
    if (trusted.empty()) return known;
    std::set<std::pair<std::uint64_t, std::uint64_t>> ends;
    session.together([&] {
      const auto file = read_graph(trusted, {.strict = flags.strict});
      for (const auto& edge : file.graph.edges()) {
        ends.insert(std::minmax(file.ids[edge.from], file.ids[edge.to]));
      }
    });
    for (std::size_t k = 0; k < known.size(); ++k) {
      known[k] = ends.contains(std::minmax(judged.ids[2 * k], judged.ids[2 * k + 1]));
    }
    return known;
  }

  void write_kept(const distributed::Session& session, const Judged& judged) const {
    std::string text = session.rank() == 0 ? "from,to,weight\n" : "";
    for (std::size_t k = 0; k < judged.edges.size(); ++k) {
      if (!stays(judged.verdicts[k], !drop_ambiguous)) continue;
      text += fmt::format("{},{},", judged.ids[2 * k], judged.ids[2 * k + 1]);
      append_number(text, judged.edges[k].weight);
      text += '\n';
    }
    write_in_order(session, output, text);
  }

  void write_verdicts_of(const distributed::Session& session, const Judged& judged) const {
    std::string text = session.rank() == 0 ? "edge,from,to,verdict,score,threshold,stage\n" : "";
    for (const auto& verdict : judged.verdicts) {
      text += fmt::format("{},{},{},{},", verdict.edge, verdict.from, verdict.to,
                          enum_name(verdict.verdict));
      append_number(text, verdict.score);
      text += ',';
      append_number(text, verdict.threshold);
      text += ',' + verdict.stage + '\n';
    }
    write_in_order(session, verdicts, text);
  }

  static void write_in_order(const distributed::Session& session, const std::string& path,
                             const std::string& text) {
    distributed::RankStream stream(session, path);
    stream.append(text);
    stream.commit();
  }

  void report(const distributed::Session& session, const distributed::Graph& graph,
              const Judged& judged, double seconds) const {
    const auto of = [&](Verdict verdict) { return session.sum(count(judged.verdicts, verdict)); };
    const auto kept = of(Verdict::keep), pruned = of(Verdict::prune);
    const auto ambiguous = of(Verdict::ambiguous);
    say(flags, fmt::format("heat-multiscale: {}, {} kept, {} pruned, {} ambiguous, {:.2f} s",
                           counted(graph.edge_count(), "edge"), kept, pruned, ambiguous, seconds));
    write_json_of(session, flags.json,
                  {{"schema", "isotherm.edges/1"},
                   {"method", "heat-multiscale"},
                   {"candidates", graph.edge_count()},
                   {"kept", kept},
                   {"pruned", pruned},
                   {"ambiguous", ambiguous},
                   {"seconds", seconds},
                   {"options", options_to_json(options)},
                   {"graph", graph_json(graph)}});
  }
};

}  // namespace

Verb add_distributed_edges(CLI::App& root, const distributed::Session& session) {
  auto edges = std::make_shared<DistributedEdges>();
  CLI::App* verb = root.add_subcommand("edges", "remove false edges, by heat-multiscale");
  verb->add_option("input", edges->input, "edge list, MatrixMarket, g2o or binary graph")
      ->required();
  verb->add_option("--trusted", edges->trusted, "edges (from,to) that are true")->type_name("FILE");
  auto& outputs = edges->flags.outputs;
  outputs.add(*verb, "-o,--output", edges->output, "kept edges to write, as CSV (- for stdout)",
              {".csv"});
  outputs.add(*verb, "--verdicts", edges->verdicts, "decision and reason an edge, as CSV",
              {".csv"});
  verb->add_flag("--drop-ambiguous", edges->drop_ambiguous, "leave out bridges, too");
  edges->add_flags(*verb);
  return verb_on_ranks(verb, edges, session);
}

}  // namespace isotherm::apps
