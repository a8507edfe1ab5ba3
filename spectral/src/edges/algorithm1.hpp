#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "isotherm/base/error.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/spectral/edges/multiscale_heat.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"

namespace isotherm::spectral::detail {

/// Algorithm 1, wherever the graph lies. `Engine` has it, on one machine or a part on each rank:
///
///     std::vector<double> scales();  // where none are asked for
///     HeatDistanceResult distances(double scale, const std::vector<std::size_t>& remaining);
///     // Of the distances of the candidates that remain.
///     Threshold threshold(const std::vector<double>& distances,
///                         const std::vector<std::size_t>& remaining, const ThresholdOptions&);
///     std::int64_t total(std::int64_t mine);  // over all parts
///     void remove(std::size_t candidate);     // its edge, from the graph
template <class Engine>
class Algorithm1 {
 public:
  Algorithm1(Engine engine, std::size_t candidates, const MultiscaleHeatOptions& options)
      : engine_(std::move(engine)), options_(options) {
    result_.verdicts.resize(candidates);
  }

  MultiscaleHeat run() && {
    const auto scales = options_.scales.empty() ? engine_.scales() : options_.scales;
    if (options_.konst.size() != 1 && options_.konst.size() != scales.size()) {
      throw InvalidArgument("konst", "must have one entry, or one per scale");
    }
    for (std::size_t s = 0; s < scales.size(); ++s) {
      prune_at(scales[s], options_.konst.size() == 1 ? options_.konst.front() : options_.konst[s]);
    }
    return std::move(result_);
  }

 private:
  static constexpr double kNoThreshold = std::numeric_limits<double>::infinity();

  void prune_at(double scale, double konst) {
    const auto remaining = remaining_candidates();
    const auto distances = distances_at(scale, remaining);
    auto round = round_at(scale, konst, distances, remaining);
    round.candidates = engine_.total(static_cast<std::int64_t>(remaining.size()));
    std::vector<double> all(result_.verdicts.size(), std::numeric_limits<double>::quiet_NaN());
    std::int64_t pruned = 0;
    for (std::size_t k = 0; k < remaining.size(); ++k) {
      all[remaining[k]] = distances[k];
      if (decide(remaining[k], distances[k], round)) ++pruned;
    }
    round.pruned = engine_.total(pruned);
    result_.rounds.push_back(round);
    result_.distances.push_back(std::move(all));
  }

  std::vector<std::size_t> remaining_candidates() const {
    std::vector<std::size_t> remaining;
    for (std::size_t c = 0; c < result_.verdicts.size(); ++c) {
      if (!result_.verdicts[c].pruned) remaining.push_back(c);
    }
    return remaining;
  }

  std::vector<double> distances_at(double scale, const std::vector<std::size_t>& remaining) {
    const auto heat = engine_.distances(scale, remaining);
    result_.unconverged += heat.unconverged;
    result_.imprecise += heat.imprecise;
    result_.widest_bracket = std::max(result_.widest_bracket, heat.widest);
    return heat.column(0);
  }

  HeatRound round_at(double scale, double konst, const std::vector<double>& distances,
                     const std::vector<std::size_t>& remaining) {
    const bool adapts = options_.threshold != ThresholdRule::mean_sigma;
    const auto found =
        engine_.threshold(distances, remaining, {.rule = options_.threshold, .konst = konst});
    const bool apart = !adapts || found.separation >= options_.min_separation;
    // At 0 all are equal, and their mean may be rounded to less than each.
    const double threshold = scale > 0.0 && apart ? found.value : kNoThreshold;
    return {scale, threshold, found.separation, adapts ? 0.0 : konst, 0, 0};
  }

  bool decide(std::size_t candidate, double distance, const HeatRound& round) {
    auto& verdict = result_.verdicts[candidate];
    double score = distance > 0.0 ? kNoThreshold : 0.0;
    if (round.threshold > 0.0) score = distance / round.threshold;
    verdict.pruned = distance > round.threshold;
    if (verdict.pruned) engine_.remove(candidate);
    if (verdict.pruned || verdict.stage.empty() || score > verdict.score) {
      verdict.score = score;
      verdict.stage = "t=" + format_number(round.scale);
    }
    return verdict.pruned;
  }

  Engine engine_;
  const MultiscaleHeatOptions& options_;
  MultiscaleHeat result_;
};

}  // namespace isotherm::spectral::detail
