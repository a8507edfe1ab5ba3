#include "isotherm/spectral/edges/multiscale_heat.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "isotherm/base/error.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"
#include "isotherm/spectral/heat/heat_scales.hpp"

namespace isotherm::spectral {
namespace {

constexpr double kNoThreshold = std::numeric_limits<double>::infinity();

double relative_to(double distance, double threshold) {
  if (threshold > 0.0) return distance / threshold;
  return distance > 0.0 ? kNoThreshold : 0.0;
}

// The state of Algorithm 1 between two scales.
class Algorithm1 {
 public:
  Algorithm1(const WeightedGraph& graph, std::span<const Index> candidates,
             const MultiscaleHeatOptions& options, const RunContext& run)
      : graph_(graph),
        candidates_(candidates),
        options_(options),
        run_(run),
        keep_(graph.edges().size(), true) {
    for (const Index edge : candidates) {
      if (edge < 0 || edge >= graph.edge_count()) {
        throw InvalidArgument("candidates", "no edge " + std::to_string(edge));
      }
    }
    result_.verdicts.resize(candidates.size());
  }

  MultiscaleHeat run() && {
    const auto scales = options_.scales.empty() ? automatic_scales(graph_, run_) : options_.scales;
    if (options_.konst.size() != 1 && options_.konst.size() != scales.size()) {
      throw InvalidArgument("konst", "must have one entry, or one per scale");
    }
    for (std::size_t s = 0; s < scales.size(); ++s) prune_at(scales[s], s);
    return std::move(result_);
  }

 private:
  double konst_at(std::size_t scale) const {
    return options_.konst.size() == 1 ? options_.konst.front() : options_.konst[scale];
  }

  std::vector<std::size_t> remaining_candidates() const {
    std::vector<std::size_t> remaining;
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      if (!result_.verdicts[c].pruned) remaining.push_back(c);
    }
    return remaining;
  }

  std::vector<double> distances_at(double scale, const std::vector<std::size_t>& remaining) {
    std::vector<VertexPair> pairs;
    for (const std::size_t c : remaining) {
      const auto& edge = graph_.edge(candidates_[c]);
      pairs.push_back({edge.from, edge.to});
    }
    const auto graph = filter_edges(graph_, keep_);
    const auto heat = heat_distances(
        graph, pairs, std::vector<double>{scale},
        {.tolerance = options_.tolerance, .threads = run_.threads, .progress = run_.progress});
    result_.unconverged += heat.unconverged;
    result_.widest_bracket = std::max(result_.widest_bracket, heat.widest);
    return heat.column(0);
  }

  Threshold threshold_at(std::size_t scale, const std::vector<double>& distances) const {
    auto threshold =
        find_threshold(distances, {.rule = options_.threshold, .konst = konst_at(scale)});
    const bool adapts = options_.threshold != ThresholdRule::mean_sigma;
    if (adapts && threshold.separation < options_.min_separation) threshold.value = kNoThreshold;
    return threshold;
  }

  void prune_at(double scale, std::size_t s) {
    const auto remaining = remaining_candidates();
    const auto distances = distances_at(scale, remaining);
    auto threshold = threshold_at(s, distances);
    // The mean of equal distances may be rounded to less than each.
    if (scale == 0.0) threshold.value = kNoThreshold;
    HeatRound round{scale,
                    threshold.value,
                    threshold.separation,
                    0.0,
                    static_cast<std::int64_t>(remaining.size()),
                    0};
    if (options_.threshold == ThresholdRule::mean_sigma) round.konst = konst_at(s);
    std::vector<double> all(candidates_.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t k = 0; k < remaining.size(); ++k) {
      all[remaining[k]] = distances[k];
      if (decide(remaining[k], distances[k], round)) ++round.pruned;
    }
    result_.rounds.push_back(round);
    result_.distances.push_back(std::move(all));
  }

  bool decide(std::size_t candidate, double distance, const HeatRound& round) {
    auto& verdict = result_.verdicts[candidate];
    const double score = relative_to(distance, round.threshold);
    verdict.pruned = distance > round.threshold;
    if (verdict.pruned) keep_[candidates_[candidate]] = false;
    if (verdict.pruned || verdict.stage.empty() || score > verdict.score) {
      verdict.score = score;
      verdict.stage = "t=" + format_number(round.scale);
    }
    return verdict.pruned;
  }

  const WeightedGraph& graph_;
  std::span<const Index> candidates_;
  const MultiscaleHeatOptions& options_;
  const RunContext& run_;
  std::vector<bool> keep_;
  MultiscaleHeat result_;
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
  return Algorithm1(graph, candidates, options, run).run();
}

}  // namespace isotherm::spectral
