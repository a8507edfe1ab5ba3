#include "report/build/network_report.hpp"
#include "isotherm/base/words.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "isotherm/geometry/points/point_alignment.hpp"
#include "report/build/candidate_columns.hpp"
#include "report/build/report_layout.hpp"
#include "report/build/spectral_report.hpp"

namespace isotherm::apps {
namespace {

using namespace network;
using spectral::EdgeVerdict;

// True positions beside the found ones, as far as both are known.
struct Comparison {
  Eigen::MatrixXd truth;       // dimension x nodes, in the frame of the result
  std::vector<double> errors;  // a node; NaN where not known
  double rmsd = 0.0;
  std::int64_t nodes = 0;
};

Comparison compare(const LocalizeResult& result, Eigen::MatrixXd truth) {
  std::vector<Eigen::Index> known;
  for (Eigen::Index v = 0; v < truth.cols(); ++v) {
    if (truth.col(v).allFinite() && result.positions.col(v).allFinite()) known.push_back(v);
  }
  if (!result.anchored && !known.empty()) {
    const Eigen::MatrixXd found = result.positions(Eigen::all, known);
    const Eigen::MatrixXd expected = truth(Eigen::all, known);
    truth = geometry::align_points(expected, found).apply(truth);
  }
  Comparison comparison{truth, {}, 0.0, static_cast<std::int64_t>(known.size())};
  comparison.errors.assign(truth.cols(), std::numeric_limits<double>::quiet_NaN());
  for (const Eigen::Index v : known) {
    comparison.errors[v] = (truth.col(v) - result.positions.col(v)).norm();
    comparison.rmsd += comparison.errors[v] * comparison.errors[v];
  }
  if (!known.empty())
    comparison.rmsd = std::sqrt(comparison.rmsd / static_cast<double>(known.size()));
  return comparison;
}

void add_truth(ReportLayout& layout, const Comparison& comparison) {
  for (Eigen::Index v = 0; v < comparison.truth.cols(); ++v) {
    layout.errors.push_back(static_cast<float>(comparison.errors[v]));
    for (Eigen::Index d = 0; d < comparison.truth.rows(); ++d) {
      layout.truth.push_back(static_cast<float>(comparison.truth(d, v) - layout.origin[d]));
    }
  }
}

void add_candidates(Report& report, const RangeNetwork& network, const LocalizeResult& result) {
  report.candidates = report_candidates(result.verdicts, [&network](const EdgeVerdict& verdict) {
    const auto& range = network.ranges[verdict.edge];
    return CandidateSource{static_cast<std::int32_t>(range.from),
                           static_cast<std::int32_t>(range.to), range.line};
  });
  ReportColumn length{"range", "range", "m", "Measured distance.", {}, false};
  ReportColumn residual{
      "residual", "residual", "m", "Measured distance less that of the positions found.", {}, true};
  for (const auto& range : network.ranges) {
    const double found = (result.positions.col(range.from) - result.positions.col(range.to)).norm();
    length.values.push_back(static_cast<float>(range.distance));
    residual.values.push_back(static_cast<float>(range.distance - found));
  }
  report.candidates.columns = {std::move(length), std::move(residual)};
}

void add_uncertainty(Report& report, const LocalizeResult& result) {
  ReportColumn sigma{
      "sigma", "standard deviation", "m", "Root of the trace of a node's covariance.", {}, true};
  for (const auto& covariance : result.covariances) {
    sigma.values.push_back(covariance.size() > 0 ? static_cast<float>(std::sqrt(covariance.trace()))
                                                 : std::numeric_limits<float>::quiet_NaN());
  }
  report.node_columns.push_back(std::move(sigma));
}

void add_spectral(Report& report, const RangeNetwork& network, const LocalizeRun& run) {
  // Pruning by heat is a stage of the robust method, which some networks need.
  const auto& stages = report.candidates.stages;
  if (std::find(stages.begin(), stages.end(), "heat") == stages.end()) {
    leave_out_spectral(report);
    return;
  }
  std::vector<spectral::WeightedEdge> edges;
  for (const auto& range : network.ranges) edges.push_back({range.from, range.to, 1.0});
  const spectral::WeightedGraph graph(network.node_count(), std::move(edges));
  const SpectralReportOptions options{.scales = scales_around(1.0),
                                      .threads = run.options.threads,
                                      .progress = run.options.progress};
  report.spectrum = report_spectrum(graph, options);
  report.heat = report_heat(graph, spectral::edge_pairs(graph), report.candidates.verdict, options);
}

std::string words_of_nodes(const LocalizeResult& result) {
  std::string text;
  for (const auto& [status, name] : enum_names(NodeStatus{})) {
    const auto nodes = result.count(status);
    if (nodes == 0) continue;
    text += text.empty() ? "" : ", ";
    text +=
        status == NodeStatus::anchor ? counted(nodes, "anchor") : fmt::format("{} {}", nodes, name);
  }
  return "Nodes: " + (text.empty() ? "none" : text) + ".";
}

std::string words_of_range_certainty(const LocalizeResult& result) {
  return fmt::format(
      "{} of {} scores are within a factor of two of their threshold. Standard deviations of "
      "ranges were multiplied by {:.3g} to fit the residuals; chi-squared is {:.4g} with {} "
      "degrees "
      "of freedom.",
      close_calls(result.verdicts), result.verdicts.size(), result.noise_factor, result.chi2,
      result.dof);
}

}  // namespace

Report network_report(const RangeNetwork& network, const LocalizeResult& result,
                      const LocalizeRun& run) {
  Report report;
  report.kind = ReportKind::network;
  report.title = run.title;
  report.dimension = network.dimension;
  report.unit = "m";
  report.nouns = {"node", "nodes", "range", "ranges", ""};
  report.options = options_to_json(run.options);
  report.node_names = network.names;
  for (const auto landmark : network.landmarks) {
    report.landmarks.push_back(static_cast<std::int32_t>(landmark));
  }
  add_candidates(report, network, result);
  add_uncertainty(report, result);
  auto layout = report_layout("after", "Positions found", result.positions.transpose());
  std::string words = words_of_nodes(result);
  report.truth_note = "No true positions were given (--ground-truth FILE).";
  if (run.truth.size() > 0) {
    const auto comparison = compare(result, run.truth);
    add_truth(layout, comparison);
    report.truth_note = fmt::format("Distance of {} from their true positions{}.",
                                    counted(comparison.nodes, "node"),
                                    result.anchored ? "" : ", after the isometry that fits best");
    words += fmt::format(" They are {:.4g} m RMS from the truth.", comparison.rmsd);
  }
  report.layouts.push_back(std::move(layout));
  add_spectral(report, network, run);
  report.summary = {
      {"What came in", fmt::format("{}: {} in {}, {} among them, and {}.", run.title,
                                   counted(network.node_count(), "node"),
                                   network.dimension == 2 ? "the plane" : "space",
                                   counted(network.landmarks.size(), "anchor"),
                                   counted(network.ranges.size(), "range"))},
      {"What was decided",
       fmt::format("Method {} {}, in {} and {:.2f} s.", enum_name(run.options.method),
                   counts_in_words(result.verdicts, report.nouns), counted(result.rounds, "round"),
                   result.seconds)},
      {"The result", words},
      {"How sure", words_of_range_certainty(result)},
      {"Options", options_in_words(report.options, options_to_json(LocalizeOptions{}))}};
  if (!result.anchored)
    report.warnings.push_back("no anchors: positions are known up to an isometry");
  if (result.status != LocalizeStatus::converged) {
    report.warnings.push_back(
        fmt::format("the localisation ended with status {}", enum_name(result.status)));
  }
  return report;
}

}  // namespace isotherm::apps
