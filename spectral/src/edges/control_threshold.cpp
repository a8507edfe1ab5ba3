#include "edges/control_threshold.hpp"

#include <cmath>

#include "edges/odds/two_groups.hpp"

namespace isotherm::spectral::detail {

Threshold decided_threshold(double value, const std::vector<double>& truth) {
  Threshold threshold{value, 0.0, !std::isfinite(value)};
  for (const double p : truth) threshold.separation += std::abs(2.0 * p - 1.0);
  if (!truth.empty()) threshold.separation /= static_cast<double>(truth.size());
  return threshold;
}

Threshold control_threshold(const std::vector<double>& scores, const std::vector<double>& truth) {
  constexpr double kSaysLittle = 0.8;  // four true edges for each false one
  const auto groups = calibrate(scores, truth);
  return decided_threshold(threshold_of_best_f(scores, groups, kSaysLittle), groups.truth);
}

std::vector<std::string> doubts_of(const std::vector<double>& scores,
                                   const std::vector<double>& truth, const Threshold& threshold,
                                   std::string_view method) {
  double pruned = 0.0, wrong = 0.0;
  for (std::size_t k = 0; k < scores.size(); ++k) {
    if (scores[k] <= threshold.value) continue;
    pruned += 1.0;
    wrong += truth[k];
  }
  if (2.0 * wrong <= pruned) return {};
  return {"of what method " + std::string(method) + " prunes here, " +
          std::to_string(std::lround(100.0 * wrong / pruned)) +
          " % are likely to be true edges: method heat tells more of this graph"};
}

}  // namespace isotherm::spectral::detail
