#pragma once

#include <vector>

#include "isotherm/base/random.hpp"

namespace isotherm_test {

/// A sum of `dof` squares of normals.
inline double chi_squared(isotherm::Random& random, int dof) {
  double sum = 0.0;
  for (int d = 0; d < dof; ++d) {
    const double z = random.normal();
    sum += z * z;
  }
  return sum;
}

/// Such sums, times the scale.
inline std::vector<double> chi_squared_sample(isotherm::Random& random, int count, int dof,
                                              double scale) {
  std::vector<double> sample(static_cast<std::size_t>(count));
  for (double& x : sample) x = scale * chi_squared(random, dof);
  return sample;
}

}  // namespace isotherm_test
