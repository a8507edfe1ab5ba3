#include "localize/problem/repeats.hpp"

#include <cmath>
#include <utility>

#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

MergedNetwork merge_repeats(const RangeNetwork& network) {
  constexpr double kMedianOfNormal = 0.6745;
  const auto& ranges = network.ranges;
  auto groups = group_by_pair(ranges);
  MergedNetwork merged{.network = network, .deviations = std::vector<double>(ranges.size())};
  merged.network.ranges.clear();
  for (const auto& group : groups.ranges) {
    RangeMeasurement pair = ranges[group.front()];
    pair.distance = median_over(group, [&](std::size_t k) { return ranges[k].distance; });
    pair.variance = median_over(group, [&](std::size_t k) { return ranges[k].variance; });
    for (const std::size_t k : group) merged.deviations[k] = ranges[k].distance - pair.distance;
    const double typical =
        median_over(group, [&](std::size_t k) { return std::abs(merged.deviations[k]); });
    merged.spreads.push_back(typical / kMedianOfNormal);
    merged.network.ranges.push_back(pair);
  }
  merged.pair_of = std::move(groups.pair_of);
  return merged;
}

spectral::EdgeVerdicts verdicts_on_repeats(const RangeNetwork& original,
                                           const MergedNetwork& merged,
                                           const spectral::EdgeVerdicts& pairs,
                                           const std::vector<double>& sigmas, double gate) {
  spectral::EdgeVerdicts verdicts;
  for (std::size_t k = 0; k < original.ranges.size(); ++k) {
    const auto p = static_cast<std::size_t>(merged.pair_of[k]);
    auto verdict = pairs[p];
    verdict.edge = static_cast<std::int64_t>(k);
    verdict.from = static_cast<std::uint64_t>(original.ranges[k].from);
    verdict.to = static_cast<std::uint64_t>(original.ranges[k].to);
    const double spread = std::max(merged.spreads[p], sigmas[p]);
    const double deviation = merged.deviations[k];
    if (deviation * deviation > gate * spread * spread) {
      verdict.verdict = spectral::Verdict::prune;
      verdict.stage = "repeats";
      verdict.score = std::pow(deviation / spread, 2);
      verdict.threshold = gate;
    }
    verdicts.push_back(std::move(verdict));
  }
  return verdicts;
}

}  // namespace isotherm::network::detail
