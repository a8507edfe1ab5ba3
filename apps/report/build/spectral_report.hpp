#pragma once

#include <cstdint>
#include <vector>

#include "isotherm/base/progress.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"
#include "report/report.hpp"

namespace isotherm::apps {

/// How much of the spectral picture is computed for a report. The limits keep a report of
/// 100,000 vertices at about the cost of writing it.
struct SpectralReportOptions {
  std::vector<double> scales;             ///< diffusion times
  spectral::Index most_vertices = 20000;  ///< a spectrum is left out beyond
  spectral::Index pairs = 50;             ///< smallest eigenpairs, null ones included
  int threads = 0;                        ///< 0: all cores
  ProgressCallback progress = {};
};

/// Seven diffusion times around the one of a run, descending.
std::vector<double> scales_around(double scale);

/// The smallest eigenvalues of the graph's Laplacian, or a note that says why not.
ReportSpectrum report_spectrum(const spectral::WeightedGraph& graph,
                               const SpectralReportOptions& options);

/// How many heat distances a report computes: 2,000 of a graph of up to 7,000 vertices,
/// fewer of larger ones, 10 from 100,000 on.
std::size_t heat_pairs(spectral::Index vertices);

/// Heat distances of candidates at all scales, to 1e-4. Where there are more than
/// heat_pairs(), those not kept come first, each kind evenly spread; the note says so.
/// `pairs` and `verdicts` (0: kept) have one entry a candidate.
ReportHeat report_heat(const spectral::WeightedGraph& graph,
                       const std::vector<spectral::VertexPair>& pairs,
                       const std::vector<std::uint8_t>& verdicts,
                       const SpectralReportOptions& options);

/// `count` of the positions [0, size), evenly spread; all of them if there are no more.
std::vector<std::size_t> spread_evenly(std::size_t size, std::size_t count);

/// Says that heat had no part in the decisions of a run, whose report has neither.
void leave_out_spectral(Report& report);

}  // namespace isotherm::apps
