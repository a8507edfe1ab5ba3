#include "short_cycles.hpp"

#include <utility>

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
  return quantile(std::move(chi2), kQuantile) / chi_squared_quantile(kQuantile, dof);
}

}  // namespace isotherm::slam::detail
