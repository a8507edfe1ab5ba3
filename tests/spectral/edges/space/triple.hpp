#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

namespace isotherm_test {

/// Three places of which 0 - 1 and 1 - 2 are edges and 0 - 2 is none, without anything of the
/// library: what is expected of their distances is integrated on a grid. Turned and moved, they are
/// the same three: two coordinates of the third place beside the first two's distance are enough.
class Triple {
 public:
  struct Distances {
    double first, second, open;  ///< 0 - 1, 1 - 2, 0 - 2
  };

  double width = 0.15, astray = 0.05, spread = 1.0;
  int dimension = 2;
  bool hears_first = true, hears_open = true;  ///< whether what is seen of the pair counts

  double rho(double distance) const { return 0.99 / (1.0 + std::exp((distance - 1.0) / width)); }

  /// E[value] over places.
  double mean(const std::function<double(const Distances&)>& value) const {
    constexpr double kFar = 6.0, kCell = 0.05;
    double sum = 0.0, total = 0.0;
    for (double r = 0.5 * kCell; r < kFar; r += kCell) {
      for (double v = 0.5 * kCell; v < kFar; v += kCell) {
        // How many ways there are to turn the three.
        const double ways = dimension == 2 ? r : r * r * v;
        for (double u = 0.5 * kCell - kFar; u < kFar; u += kCell) {
          const Distances apart{r, std::hypot(u - r, v), std::hypot(u, v)};
          const double density = ways * probability(apart);
          total += density;
          sum += density * value(apart);
        }
      }
    }
    return sum / total;
  }

 private:
  /// An edge no longer than 1 less five widths, and a pair without one from 1 and five on, count as
  /// there.
  double probability(const Distances& apart) const {
    const double edge = 1.0 - 5.0 * width, open = 1.0 + 5.0 * width;
    double chance = rho(std::max(apart.second, edge)) + astray;
    if (hears_first) chance *= rho(std::max(apart.first, edge)) + astray;
    if (hears_open) chance *= 1.0 - rho(std::min(apart.open, open));
    // Three normal places whose middle may lie anywhere.
    const double squares =
        apart.first * apart.first + apart.second * apart.second + apart.open * apart.open;
    return chance * std::exp(-squares / (6.0 * spread * spread));
  }
};

}  // namespace isotherm_test
