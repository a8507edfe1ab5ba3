#include "prune/consensus/climb/starts.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace isotherm::slam::detail {
namespace {

// Each of both factors has as many nodes, a factor of ten apart, to a deviation of the prior.
constexpr int kSide = 5;

double factor_at(int node) { return std::exp(kScaleDeviation * (2.0 * node / (kSide - 1) - 1.0)); }

// More than at any node around; of equal ones the first.
bool is_peak(const std::vector<double>& gains, int odometry, int loops) {
  const int here = odometry * kSide + loops;
  if (gains[here] <= 0.0) return false;
  for (int i = std::max(odometry - 1, 0); i <= std::min(odometry + 1, kSide - 1); ++i) {
    for (int j = std::max(loops - 1, 0); j <= std::min(loops + 1, kSide - 1); ++j) {
      const int there = i * kSide + j;
      if (gains[there] > gains[here] || (gains[there] == gains[here] && there < here)) return false;
    }
  }
  return true;
}

}  // namespace

template <class Pose>
std::vector<CovarianceScale> gaining_starts(Climb<Pose>& climb) {
  std::vector<CovarianceScale> grid;
  for (int node = 0; node < kSide * kSide; ++node) {
    grid.push_back({factor_at(node / kSide), factor_at(node % kSide)});
  }
  const auto gains = climb.first_gains(grid);
  std::vector<std::pair<double, CovarianceScale>> peaks;
  for (int node = 0; node < kSide * kSide; ++node) {
    if (is_peak(gains, node / kSide, node % kSide)) peaks.emplace_back(gains[node], grid[node]);
  }
  std::ranges::stable_sort(peaks, std::greater{}, &std::pair<double, CovarianceScale>::first);
  std::vector<CovarianceScale> starts;
  for (const auto& [gain, scale] : peaks) starts.push_back(scale);
  return starts;
}

template std::vector<CovarianceScale> gaining_starts(Climb<Pose2>&);
template std::vector<CovarianceScale> gaining_starts(Climb<Pose3>&);

}  // namespace isotherm::slam::detail
