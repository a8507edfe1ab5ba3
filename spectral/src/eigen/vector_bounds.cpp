#include "isotherm/spectral/eigen/vector_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isotherm::spectral {
namespace {

/// Pairs first to last, whose values cannot be told apart.
struct Group {
  Index first = 0;
  Index last = 0;
};

// Orthonormal vectors with these residuals have as many eigenvalues of their own, each within
// the root of the sum of squares (Kahan 1967).
double reach_of(const EigenDecomposition& eigen) {
  return eigen.bounds.tail(eigen.count() - eigen.null_count).norm();
}

std::vector<Group> groups_of(const EigenDecomposition& eigen, double reach) {
  std::vector<Group> groups;
  for (Index k = eigen.null_count; k < eigen.count(); ++k) {
    const bool together = !groups.empty() && eigen.values[k] - eigen.values[k - 1] <= 2.0 * reach;
    if (together) groups.back().last = k;
    if (!together) groups.push_back({k, k});
  }
  return groups;
}

}  // namespace

VectorBounds vector_bounds(const EigenDecomposition& eigen, bool complete) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  VectorBounds result;
  result.group.assign(static_cast<std::size_t>(eigen.null_count), 0);
  result.sines = Eigen::VectorXd::Zero(eigen.count());
  const double reach = reach_of(eigen);
  const bool known = eigen.status == EigenStatus::converged;
  const auto groups = groups_of(eigen, reach);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto [first, last] = groups[g];
    const bool open = g + 1 == groups.size() && !complete;
    const double below = first > eigen.null_count ? eigen.values[first - 1] : -kInfinity;
    const double above = last + 1 < eigen.count() ? eigen.values[last + 1] : kInfinity;
    for (Index k = first; k <= last; ++k) {
      const double gap = std::min(eigen.values[k] - below, above - eigen.values[k]) - reach;
      const double sine = eigen.bounds[k] / gap;
      result.group.push_back(first);
      result.sines[k] = known && !open && gap > 0.0 ? std::min(sine, 1.0) : 1.0;
    }
  }
  return result;
}

}  // namespace isotherm::spectral
