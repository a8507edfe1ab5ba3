#include "prune/consensus/calibrate/short_cycles.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

#include "isotherm/base/statistics.hpp"
#include "prune/consensus/calibrate/octave_counts.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr double kQuantile = 0.2;
constexpr std::size_t kFewestCycles = 50;
// Loops that were copied along odometry close to rounding, and say nothing of accuracy.
constexpr double kCopied = 1e-8;
// The octave that parts two crowds has at most one in so many of either's fullest.
constexpr double kDepth = 2.0;

bool towers_over(double crowd, double gap) { return crowd > kDepth * gap && more(crowd, gap); }

// How many belong to the lower of two crowds; all if there is one.
std::size_t lower_crowd(const OctaveCounts& cycles) {
  const double step = std::exp2(1.0 / kStepsPerOctave);
  double fullest = 0.0;
  double fewest = 0.0;
  double gap = 0.0;
  for (double x = cycles.values().front(); x < cycles.values().back(); x *= step) {
    const double count = cycles.around(x);
    const bool fell = towers_over(fullest, fewest) && cycles.below(gap) >= kFewestCycles;
    if (fell && towers_over(count, fewest)) return cycles.below(gap);
    if (!fell && count > fullest) {
      fullest = fewest = count;
    } else if (count < fewest) {
      fewest = count;
      gap = x;
    }
  }
  return cycles.values().size();
}

}  // namespace

double cycle_scale(std::vector<double> chi2, int dof) {
  std::erase_if(chi2, [](double x) { return x < kCopied || !std::isfinite(x); });
  if (chi2.size() < kFewestCycles) return 1.0;
  const OctaveCounts cycles(std::move(chi2));
  const auto crowd = static_cast<std::ptrdiff_t>(lower_crowd(cycles));
  return quantile({cycles.values().begin(), cycles.values().begin() + crowd}, kQuantile) /
         chi_squared_quantile(kQuantile, dof);
}

}  // namespace isotherm::slam::detail
