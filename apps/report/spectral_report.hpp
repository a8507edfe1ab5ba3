#pragma once

#include <cstdint>
#include <vector>

#include "isotherm/base/progress.hpp"
#include "isotherm/spectral/heat_distance.hpp"
#include "isotherm/spectral/weighted_graph.hpp"
#include "report.hpp"

namespace isotherm::apps {

/// How much of the spectral picture is computed for a report.
struct SpectralReportOptions {
  std::vector<double> scales;    ///< diffusion times
  std::size_t heat_pairs = 500;  ///< candidates whose heat distances are computed, at most
  int threads = 0;               ///< 0: all cores
  ProgressCallback progress = {};
};

/// The smallest eigenvalues: 50 of a graph of up to 10,000 vertices, 12 of a larger one.
ReportSpectrum report_spectrum(const spectral::WeightedGraph& graph,
                               const SpectralReportOptions& options);

/// Heat distances of candidates at all scales, to 1e-4. Where there are more candidates
/// than `heat_pairs`, those not kept come first, each kind evenly spread; the note says
/// so. `pairs` and `verdicts` (0: kept) have one entry a candidate.
ReportHeat report_heat(const spectral::WeightedGraph& graph,
                       const std::vector<spectral::VertexPair>& pairs,
                       const std::vector<std::uint8_t>& verdicts,
                       const SpectralReportOptions& options);

/// `count` of the positions [0, size), evenly spread; all of them if there are no more.
std::vector<std::size_t> spread_evenly(std::size_t size, std::size_t count);

}  // namespace isotherm::apps
