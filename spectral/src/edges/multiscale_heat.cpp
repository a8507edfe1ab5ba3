#include "isotherm/spectral/edges/multiscale_heat.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "edges/algorithm1.hpp"
#include "edges/calibrated_heat.hpp"
#include "edges/odds/two_groups.hpp"
#include "isotherm/spectral/heat/heat_scales.hpp"

namespace isotherm::spectral {
namespace {

// The whole graph, of which edges that are pruned are left out.
class OneMachine {
 public:
  OneMachine(const WeightedGraph& graph, std::span<const Index> candidates, double tolerance,
             const RunContext& run)
      : graph_(graph),
        candidates_(candidates),
        tolerance_(tolerance),
        run_(run),
        keep_(graph.edges().size(), true) {
    for (const Index edge : candidates) {
      if (edge < 0 || edge >= graph.edge_count()) {
        throw InvalidArgument("candidates", "no edge " + std::to_string(edge));
      }
    }
  }

  std::vector<double> scales() const { return automatic_scales(graph_, run_); }

  HeatDistanceResult distances(double scale, const std::vector<std::size_t>& remaining) const {
    std::vector<VertexPair> pairs;
    for (const std::size_t c : remaining) {
      const auto& edge = graph_.edge(candidates_[c]);
      pairs.push_back({edge.from, edge.to});
    }
    return heat_distances(
        filter_edges(graph_, keep_), pairs, std::vector<double>{scale},
        {.tolerance = tolerance_, .threads = run_.threads, .progress = run_.progress});
  }

  static Threshold threshold(const std::vector<double>& distances, const std::vector<std::size_t>&,
                             const ThresholdOptions& rule) {
    return find_threshold(distances, rule);
  }

  static std::int64_t total(std::int64_t mine) { return mine; }

  void remove(std::size_t candidate) { keep_[candidates_[candidate]] = false; }

 private:
  const WeightedGraph& graph_;
  std::span<const Index> candidates_;
  double tolerance_;
  const RunContext& run_;
  std::vector<bool> keep_;
};

// The same, with thresholds by what else has told of the edges.
class CalibratedMachine : public OneMachine {
 public:
  CalibratedMachine(OneMachine machine, std::span<const double> truth)
      : OneMachine(std::move(machine)), truth_(truth) {}

  Threshold threshold(const std::vector<double>& distances,
                      const std::vector<std::size_t>& remaining, const ThresholdOptions&) const {
    constexpr double kEven = 0.5;  // at every scale: more likely false than true
    std::vector<double> truth;
    for (const std::size_t candidate : remaining) truth.push_back(truth_[candidate]);
    const double value =
        detail::threshold_of_best_f(distances, detail::calibrate(distances, truth), kEven);
    // Where none is to be pruned, scores are relative to the largest.
    if (std::isfinite(value) || distances.empty()) return {.value = value};
    return {.value = std::ranges::max(distances)};
  }

 private:
  std::span<const double> truth_;  // of the candidates
};

}  // namespace

void MultiscaleHeatOptions::validate() const {
  for (std::size_t k = 0; k < scales.size(); ++k) {
    if (!(std::isfinite(scales[k]) && scales[k] >= 0.0)) {
      throw InvalidArgument("scales", "must be finite and not negative");
    }
    if (k > 0 && scales[k] >= scales[k - 1]) {
      throw InvalidArgument("scales", "must be descending");
    }
  }
  const bool fits = konst.size() == 1 || scales.empty() || konst.size() == scales.size();
  if (konst.empty() || !fits) {
    throw InvalidArgument("konst", "must have one entry, or one per scale");
  }
  for (const double value : konst) {
    if (!std::isfinite(value)) throw InvalidArgument("konst", "must be finite");
  }
  if (!(min_separation >= 0.0 && min_separation <= 1.0)) {
    throw InvalidArgument("min_separation", "must be in [0, 1]");
  }
  if (!(tolerance > 0.0)) throw InvalidArgument("tolerance", "must be positive");
}

MultiscaleHeat multiscale_heat(const WeightedGraph& graph, std::span<const Index> candidates,
                               const MultiscaleHeatOptions& options, const RunContext& run) {
  options.validate();
  return detail::Algorithm1(OneMachine(graph, candidates, options.tolerance, run),
                            candidates.size(), options)
      .run();
}

MultiscaleHeat detail::calibrated_heat(const WeightedGraph& graph,
                                       std::span<const Index> candidates,
                                       std::span<const double> truth,
                                       const MultiscaleHeatOptions& options,
                                       const RunContext& run) {
  options.validate();
  OneMachine machine(graph, candidates, options.tolerance, run);
  return Algorithm1(CalibratedMachine(std::move(machine), truth), candidates.size(), options).run();
}

}  // namespace isotherm::spectral
