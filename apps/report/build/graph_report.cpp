#include "report/build/graph_report.hpp"
#include "isotherm/base/words.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "isotherm/spectral/eigen/embedding.hpp"
#include "report/build/candidate_columns.hpp"
#include "report/build/report_layout.hpp"
#include "report/build/spectral_report.hpp"

namespace isotherm::apps {
namespace {

using namespace spectral;

// Two coordinates a vertex; those that a graph with too few edges does not have are 0.
Eigen::MatrixXd coordinates(const WeightedGraph& graph, const ProgressCallback& progress) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(graph.vertex_count(), 2);
  const Laplacian laplacian(graph);
  const auto eigen = smallest_eigenpairs(laplacian, {.count = 2,
                                                     .null_vectors = false,
                                                     .tolerance = 1e-8,
                                                     .check_inertia = false,
                                                     .progress = progress});
  const Eigen::MatrixXd found = commute_time_embedding(eigen);
  const Eigen::Index columns = std::min<Eigen::Index>(2, found.cols());
  rows.leftCols(columns) = found.leftCols(columns);
  return rows;
}

void add_layouts(Report& report, const WeightedGraph& graph, const WeightedGraph& left,
                 const EdgesRun& run, const ProgressCallback& progress) {
  const auto dimension = run.points.rows();
  if (dimension == 2 || dimension == 3) {
    report.dimension = static_cast<int>(dimension);
    report.layouts.push_back(
        report_layout("points", "The points, where they are", run.points.transpose()));
    return;
  }
  report.layouts.push_back(report_layout("before", "Before: commute-time coordinates, all edges",
                                         coordinates(graph, progress)));
  report.layouts.push_back(report_layout("after", "After: commute-time coordinates, kept edges",
                                         coordinates(left, progress)));
}

void add_candidates(Report& report, const WeightedGraph& graph, const EdgeVerdicts& verdicts) {
  report.candidates = report_candidates(verdicts, [&graph](const EdgeVerdict& verdict) {
    const auto& edge = graph.edge(static_cast<Index>(verdict.edge));
    return CandidateSource{static_cast<std::int32_t>(edge.from), static_cast<std::int32_t>(edge.to),
                           0};
  });
  ReportColumn weight{"weight", "weight", "", "Affinity of the edge, as the input has it.",
                      {},       true};
  for (const auto& edge : graph.edges()) weight.values.push_back(static_cast<float>(edge.weight));
  report.candidates.columns.push_back(std::move(weight));
}

bool heat_decides(EdgeScore method) {
  return method == EdgeScore::heat || method == EdgeScore::heat_multiscale ||
         method == EdgeScore::affinity;
}

void add_spectral(Report& report, const WeightedGraph& graph, const JudgeEdgesOptions& judged,
                  const RunContext& context) {
  if (!heat_decides(judged.method)) {
    leave_out_spectral(report);
    return;
  }
  const SpectralReportOptions options{.scales = scales_around(judged.scale),
                                      .threads = context.threads,
                                      .progress = context.progress};
  report.spectrum = report_spectrum(graph, options);
  report.heat = report_heat(graph, edge_pairs(graph), report.candidates.verdict, options);
}

std::string words_of_threshold(const JudgeEdgesResult& result) {
  return fmt::format(
      "{} of {} scores are within a factor of two of their threshold. The threshold {:.4g} was "
      "found from the scores; they split with a separation of {:.2f}, where 1 is perfect.",
      close_calls(result.verdicts), result.verdicts.size(), result.threshold.value,
      result.threshold.separation);
}

}  // namespace

Report graph_report(const WeightedGraph& graph, const WeightedGraph& left,
                    const JudgeEdgesResult& result, const EdgesRun& run,
                    const RunContext& context) {
  Report report;
  report.kind = ReportKind::graph;
  report.title = run.title;
  report.nouns = {"vertex", "vertices", "edge", "edges", ""};
  report.options = options_to_json(run.options);
  report.node_ids = run.ids;
  add_layouts(report, graph, left, run, context.progress);
  add_candidates(report, graph, result.verdicts);
  add_spectral(report, graph, run.options, context);
  report.warnings = result.warnings;
  report.truth_note = "A plain graph has no true positions to compare with.";
  const auto parts = [](const WeightedGraph& part) { return connected_components(part).count; };
  report.summary = {
      {"What came in",
       fmt::format("{}: {} and {} in {}.", run.title,
                   counted(graph.vertex_count(), "vertex", "vertices"),
                   counted(graph.edge_count(), "edge"), counted(parts(graph), "connected part"))},
      {"What was decided",
       fmt::format("Method {} {}, in {:.2f} s.", enum_name(run.options.method),
                   counts_in_words(result.verdicts, report.nouns), result.seconds)},
      {"The result",
       fmt::format("The graph that is left has {} in {}.", counted(left.edge_count(), "edge"),
                   counted(parts(left), "connected part"))},
      {"How sure", words_of_threshold(result)},
      {"Options", options_in_words(report.options, options_to_json(JudgeEdgesOptions{}))}};
  return report;
}

}  // namespace isotherm::apps
