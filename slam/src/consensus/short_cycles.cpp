#include "short_cycles.hpp"

#include <algorithm>

#include "isotherm/base/statistics.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr double kQuantile = 0.2;
constexpr std::size_t kFewestCycles = 50;
// Loops that were copied along odometry close to rounding, and say nothing of accuracy.
constexpr double kRounding = 1e-8;

}  // namespace

double cycle_scale(std::vector<double> chi2, int dof) {
  std::erase_if(chi2, [](double x) { return x < kRounding; });
  if (chi2.size() < kFewestCycles) return 1.0;
  const auto at =
      chi2.begin() + static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(chi2.size()));
  std::nth_element(chi2.begin(), at, chi2.end());
  return *at / chi_squared_quantile(kQuantile, dof);
}

}  // namespace isotherm::slam::detail
