#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "console.hpp"
#include "help_formatter.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/words.hpp"
#include "isotherm/geometry/points/neighbour_graph.hpp"
#include "isotherm/geometry/points/point_cloud.hpp"
#include "isotherm/network/io/position_file.hpp"
#include "isotherm/spectral/edges/judge_edges.hpp"
#include "isotherm/spectral/edges/verdict_file.hpp"
#include "isotherm/spectral/graph/graph_file.hpp"
#include "option_verb.hpp"
#include "report/build/graph_report.hpp"
#include "report/report_flags.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using namespace spectral;

// What each method needs, when it is the one to take, and what it costs.
constexpr std::array<HelpChoice, 7> kEdgeMethods = {{
    {"heat",
     "the default: walks between the ends of an edge without it; finds false edges side by side, "
     "too. Vertices times the edges a few steps around"},
    {"heat-multiscale",
     "heat distance, from large scales to small ones, as the paper has it; knows trusted edges. "
     "Some sparse factorisations a scale"},
    {"affinity", "heat at one scale, with proven bounds. A heat distance an edge"},
    {"resistance",
     "how badly the rest conducts. Poor where neighbourhoods are dense; some ten factorisations"},
    {"jaccard", "share of common neighbours. Needs triangles; quickest"},
    {"common-neighbours", "number of common neighbours. The same"},
    {"rank", "how many vertices lie nearer. Needs --positions or points; quick"},
}};

struct EdgesVerb : OptionVerb<JudgeEdgesOptions> {
  std::string input;
  std::string output;
  std::string verdicts;
  bool drop_ambiguous = false;
  std::string positions;          // of the vertices, a file
  std::string trusted;            // edges, a file
  std::optional<int> neighbours;  // of a point, where the input is a cloud
  std::optional<double> radius;   // in the unit of the cloud
  ReportFlags explain;

  struct Input : GraphFile {
    Eigen::MatrixXd points;  // dimension x vertices; empty if not known
  };

  int run() {
    if (resolve_or_dump()) return kOk;
    if (!positions.empty() && options.method != EdgeScore::rank && !explain.wanted()) {
      throw InvalidArgument("positions",
                            "have no use: they are for --method rank, to judge by, "
                            "and for --report and --svg, to draw at");
    }
    const RunContext context{flags.threads, progress_line(flags), flags.seed};
    const auto file = read_input(context);
    for (const auto& diagnostic : file.report.diagnostics) warn(flags, to_string(diagnostic));
    if (!trusted.empty()) options.trusted = trusted_edges(file);
    auto result = judge_edges(file.graph, options, file.points, context);
    for (const auto& warning : result.warnings) warn(flags, warning);
    const auto left = apply_verdicts(file.graph, result.verdicts, !drop_ambiguous);
    if (explain.wanted()) {
      const EdgesRun run{file_title(input), options, file.ids, file.points};
      write_report(explain, graph_report(file.graph, left, result, run, context));
    }
    name_vertices(result.verdicts, file.ids);
    report(result);
    if (!output.empty()) write_edge_csv(output, left, file.ids);
    if (!verdicts.empty()) write_verdicts(verdicts, result.verdicts);
    write_json(flags.json, to_json(result));
    return kOk;
  }

  // The graph of the file, or of the points in it.
  Input read_input(const RunContext& context) const {
    if (!neighbours && !radius) {
      auto file = read_graph(input, {.strict = flags.strict});
      merge_directions(file, {.strict = flags.strict});
      auto points = positions.empty() ? Eigen::MatrixXd() : positions_of(file.ids);
      return {std::move(file), std::move(points)};
    }
    auto cloud = geometry::read_points(input);
    Input file;
    file.graph = neighbours ? geometry::nearest_neighbour_graph(cloud.points, *neighbours, context)
                            : geometry::radius_graph(cloud.points, *radius, context);
    file.ids = std::move(cloud.ids);
    file.report = std::move(cloud.report);
    file.points = std::move(cloud.points);
    return file;
  }

  // Those that the file of trusted edges has, in either direction.
  std::vector<Index> trusted_edges(const Input& file) const {
    if (options.method != EdgeScore::heat_multiscale) {
      throw InvalidArgument("trusted", "only method heat-multiscale knows trusted edges");
    }
    const auto known = read_graph(trusted, {.strict = flags.strict});
    std::set<std::pair<std::uint64_t, std::uint64_t>> ends;
    for (const auto& edge : known.graph.edges()) {
      ends.insert(std::minmax(known.ids[edge.from], known.ids[edge.to]));
    }
    std::vector<Index> edges;
    for (Index e = 0; e < file.graph.edge_count(); ++e) {
      const auto& edge = file.graph.edge(e);
      if (ends.contains(std::minmax(file.ids[edge.from], file.ids[edge.to]))) edges.push_back(e);
    }
    return edges;
  }

  // Those of the vertices, from their file, which may have more.
  Eigen::MatrixXd positions_of(const std::vector<std::uint64_t>& ids) const {
    const auto file = network::read_positions(positions);
    const auto column_of = file.column_of();
    std::vector<Eigen::Index> columns;
    for (const auto id : ids) {
      const auto found = column_of.find(std::to_string(id));
      if (found == column_of.end()) {
        throw ParseError({positions, 0, 0}, std::to_string(id), "no position of this vertex");
      }
      columns.push_back(found->second);
    }
    return file.positions(Eigen::all, columns);
  }

  // Verdict files carry the input's own vertex numbers.
  static void name_vertices(EdgeVerdicts& all, const std::vector<std::uint64_t>& ids) {
    for (auto& verdict : all) {
      verdict.from = ids[verdict.from];
      verdict.to = ids[verdict.to];
    }
  }

  Json to_json(const JudgeEdgesResult& result) const {
    const double threshold = result.threshold.value;
    return {{"schema", "isotherm.edges/1"},
            {"method", enum_name(options.method)},
            {"candidates", result.verdicts.size()},
            {"kept", count(result.verdicts, Verdict::keep)},
            {"pruned", count(result.verdicts, Verdict::prune)},
            {"ambiguous", count(result.verdicts, Verdict::ambiguous)},
            // JSON has no infinity; null stands for "nothing to split".
            {"threshold", std::isfinite(threshold) ? Json(threshold) : Json()},
            {"separation", result.threshold.separation},
            {"warnings", result.warnings},
            {"seconds", result.seconds},
            {"options", options_to_json(options)}};
  }

  void report(const JudgeEdgesResult& result) const {
    say(flags,
        fmt::format("{}: {}, {} kept, {} pruned, {} ambiguous, {:.2f} s", enum_name(options.method),
                    counted(result.verdicts.size(), "edge"), count(result.verdicts, Verdict::keep),
                    count(result.verdicts, Verdict::prune),
                    count(result.verdicts, Verdict::ambiguous), result.seconds));
  }
};

}  // namespace

Verb add_edges(CLI::App& root) {
  auto edges = std::make_shared<EdgesVerb>();
  CLI::App* verb = root.add_subcommand("edges", "remove false edges from a weighted graph");
  verb->add_option("input", edges->input, "edge list, MatrixMarket or point file (- for stdin)")
      ->required();
  auto* neighbours =
      add_number(*verb, "--neighbours", edges->neighbours,
                 "the input is points: join each to so many nearest ones", closed(1, 1e6))
          ->type_name("COUNT");
  auto* radius = add_number(*verb, "--radius", edges->radius,
                            "the input is points: join those at most so far from each other",
                            left_open(0, 1e12))
                     ->type_name("DISTANCE")
                     ->excludes(neighbours);
  verb->add_option("--positions", edges->positions,
                   "node,x,y[,z] of the vertices: for --method rank, and to draw them")
      ->type_name("FILE")
      ->excludes(neighbours)
      ->excludes(radius);
  verb->add_option("--trusted", edges->trusted,
                   "edges (from,to) that are true, for --method heat-multiscale")
      ->type_name("FILE");
  auto& outputs = edges->flags.outputs;
  outputs.add(*verb, "-o,--output", edges->output, "kept edges to write, as CSV (- for stdout)",
              {".csv"});
  outputs.add(*verb, "--verdicts", edges->verdicts, "decision and reason an edge, as CSV",
              {".csv"});
  verb->add_flag("--drop-ambiguous", edges->drop_ambiguous,
                 "leave out edges that are not proven either way, too, such as bridges");
  edges->explain.add_to(*verb, outputs);
  edges->add_flags(*verb);
  verb->footer(help_table("Methods:", kEdgeMethods));
  return verb_of(verb, edges);
}

}  // namespace isotherm::apps
