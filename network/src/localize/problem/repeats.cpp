#include "localize/problem/repeats.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

MergedNetwork merge_repeats(const RangeNetwork& network) {
  MergedNetwork merged;
  merged.network = network;
  auto& pairs = merged.network.ranges;
  pairs.clear();
  std::map<std::pair<Index, Index>, Index> number_of;
  std::vector<std::vector<double>> distances;
  std::vector<std::vector<double>> variances;
  for (const auto& range : network.ranges) {
    const auto [entry, added] =
        number_of.try_emplace(std::minmax(range.from, range.to), static_cast<Index>(pairs.size()));
    if (added) {
      pairs.push_back(range);
      distances.emplace_back();
      variances.emplace_back();
    }
    merged.pair_of.push_back(entry->second);
    distances[entry->second].push_back(range.distance);
    variances[entry->second].push_back(range.variance);
  }
  std::vector<std::vector<double>> sizes(pairs.size());
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    pairs[p].distance = lower_median(distances[p]);
    pairs[p].variance = lower_median(variances[p]);
  }
  for (std::size_t k = 0; k < network.ranges.size(); ++k) {
    const auto p = static_cast<std::size_t>(merged.pair_of[k]);
    merged.deviations.push_back(network.ranges[k].distance - pairs[p].distance);
    sizes[p].push_back(std::abs(merged.deviations.back()));
  }
  constexpr double kMedianOfNormal = 0.6745;
  for (auto& pair : sizes) merged.spreads.push_back(lower_median(pair) / kMedianOfNormal);
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
