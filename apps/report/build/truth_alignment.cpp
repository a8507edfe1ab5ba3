#include "report/build/truth_alignment.hpp"

#include <limits>

#include "isotherm/base/error.hpp"

namespace isotherm::apps {
namespace {

using namespace slam;

template <class Pose>
Pose best_alignment(const PosePairs<Pose>& pairs) {
  try {
    return align(pairs, Alignment::se);
  } catch (const InvalidArgument&) {
    return align(pairs, Alignment::first);
  }
}

}  // namespace

template <class Pose>
std::optional<TruthComparison> compare_with_truth(const std::vector<Pose>& estimate,
                                                  const std::vector<std::optional<Pose>>& truth,
                                                  const std::vector<double>& origin) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const auto pairs = pair_poses(estimate, truth);
  if (pairs.truth.empty()) return std::nullopt;
  const Pose T_truth_estimate = best_alignment(pairs);
  const Pose T_estimate_truth = T_truth_estimate.inverse();
  TruthComparison comparison;
  std::vector<double> errors;
  for (std::size_t k = 0; k < estimate.size(); ++k) {
    comparison.errors.push_back(kNaN);
    comparison.truth.insert(comparison.truth.end(), Pose::kDim, kNaN);
    if (!truth[k]) continue;
    const auto there = T_estimate_truth * truth[k]->translation();
    errors.push_back((there - estimate[k].translation()).norm());
    comparison.errors.back() = static_cast<float>(errors.back());
    for (int d = 0; d < Pose::kDim; ++d) {
      comparison.truth[k * Pose::kDim + d] = static_cast<float>(there[d] - origin[d]);
    }
  }
  comparison.statistics = summarize(std::move(errors));
  return comparison;
}

template std::optional<TruthComparison> compare_with_truth(const std::vector<Pose2>&,
                                                           const std::vector<std::optional<Pose2>>&,
                                                           const std::vector<double>&);
template std::optional<TruthComparison> compare_with_truth(const std::vector<Pose3>&,
                                                           const std::vector<std::optional<Pose3>>&,
                                                           const std::vector<double>&);

}  // namespace isotherm::apps
