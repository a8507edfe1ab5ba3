#include "report/build/spectral_report.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "isotherm/spectral/eigen/eigen_decomposition.hpp"

namespace isotherm::apps {
namespace {

using namespace spectral;

constexpr double kHeatTolerance = 1e-4;

std::vector<std::uint32_t> spread_of(const std::vector<std::uint32_t>& all, std::size_t count) {
  std::vector<std::uint32_t> chosen;
  for (const std::size_t k : spread_evenly(all.size(), count)) chosen.push_back(all[k]);
  return chosen;
}

// Half of the room goes to what was not kept, whose reasons are asked for most; what one
// kind leaves, the other takes.
std::vector<std::uint32_t> choose_candidates(const std::vector<std::uint8_t>& verdicts,
                                             std::size_t room) {
  std::vector<std::uint32_t> kept;
  std::vector<std::uint32_t> others;
  for (std::uint32_t k = 0; k < verdicts.size(); ++k)
    (verdicts[k] == 0 ? kept : others).push_back(k);
  const std::size_t kept_room = std::max(room / 2, room - std::min(room, others.size()));
  auto chosen = spread_of(kept, kept_room);
  const auto rest = spread_of(others, room - chosen.size());
  chosen.insert(chosen.end(), rest.begin(), rest.end());
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace

std::vector<std::size_t> spread_evenly(std::size_t size, std::size_t count) {
  count = std::min(size, count);
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < count; ++k) chosen.push_back(k * size / count);
  return chosen;
}

std::vector<double> scales_around(double scale) {
  std::vector<double> scales;
  for (const double factor : {100.0, 30.0, 10.0, 3.0, 1.0, 0.3, 0.1}) {
    scales.push_back(factor * scale);
  }
  return scales;
}

std::size_t heat_pairs(Index vertices) {
  constexpr double kWork = 1e11;  // pairs x vertices^2
  const double size = std::max<double>(vertices, 1.0);
  return static_cast<std::size_t>(std::clamp(kWork / (size * size), 10.0, 2000.0));
}

ReportSpectrum report_spectrum(const WeightedGraph& graph, const SpectralReportOptions& options) {
  ReportSpectrum spectrum;
  spectrum.scales = options.scales;
  const Index vertices = graph.vertex_count();
  if (vertices == 0 || vertices > options.most_vertices) {
    spectrum.note = vertices == 0 ? "The graph has no vertices."
                                  : fmt::format(
                                        "Left out for graphs of more than {} vertices; 'isotherm "
                                        "embed' computes it.",
                                        options.most_vertices);
    return spectrum;
  }
  const auto eigen =
      smallest_eigenpairs(Laplacian(graph), {.count = std::min(options.pairs, vertices),
                                             .tolerance = 1e-8,
                                             .check_inertia = false,
                                             .progress = options.progress});
  spectrum.values.assign(eigen.values.data(), eigen.values.data() + eigen.count());
  spectrum.null_count = eigen.null_count;
  spectrum.note = fmt::format(
      "The {} smallest of {} eigenvalues of the Laplacian of the graph with all candidates. One "
      "a connected part is 0: {} here.{}",
      eigen.count(), vertices, eigen.null_count,
      eigen.status == EigenStatus::converged ? "" : " Some have not converged to the tolerance.");
  return spectrum;
}

ReportHeat report_heat(const WeightedGraph& graph, const std::vector<VertexPair>& pairs,
                       const std::vector<std::uint8_t>& verdicts,
                       const SpectralReportOptions& options) {
  ReportHeat heat;
  heat.scales = options.scales;
  heat.candidates = choose_candidates(verdicts, heat_pairs(graph.vertex_count()));
  std::vector<VertexPair> chosen;
  for (const auto k : heat.candidates) chosen.push_back(pairs[k]);
  const auto result = heat_distances(
      graph, chosen, heat.scales,
      {.tolerance = kHeatTolerance, .threads = options.threads, .progress = options.progress});
  for (const auto& value : result.values) heat.distances.push_back(static_cast<float>(value.value));
  heat.note = "Of the graph with all candidates.";
  if (heat.candidates.size() < pairs.size()) {
    heat.note += fmt::format(
        " Computed for {} of {} candidates: up to half of them pruned or "
        "ambiguous, each kind evenly spread.",
        heat.candidates.size(), pairs.size());
  }
  return heat;
}

void leave_out_spectral(Report& report) {
  report.heat.note = "Heat decided nothing in this run.";
  report.spectrum.note = report.heat.note;
}

}  // namespace isotherm::apps
