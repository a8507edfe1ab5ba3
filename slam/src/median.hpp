#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace isotherm::slam {

/// The middle one, or the mean of the middle two; `values` is not empty. O(n).
inline double median(std::vector<double> values) {
  const auto half = static_cast<std::ptrdiff_t>(values.size() / 2);
  const auto upper = values.begin() + half;
  std::nth_element(values.begin(), upper, values.end());
  if (values.size() % 2 == 1) return *upper;
  return 0.5 * (*upper + *std::max_element(values.begin(), upper));
}

}  // namespace isotherm::slam
