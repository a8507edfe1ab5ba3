#include "tridiagonal.hpp"

#include <cmath>
#include <limits>

#include "isotherm/base/error.hpp"

namespace isotherm::spectral::detail {
namespace {

constexpr int kMaxSweeps = 60;

/// One implicit QL sweep on rows [first, last], chasing the bulge upwards.
void ql_sweep(std::vector<double>& d, std::vector<double>& e, std::vector<double>& z, int first,
              int last) {
  double g = (d[first + 1] - d[first]) / (2.0 * e[first]);
  double r = std::hypot(g, 1.0);
  g = d[last] - d[first] + e[first] / (g + std::copysign(r, g));
  double s = 1.0;
  double c = 1.0;
  double p = 0.0;
  for (int i = last - 1; i >= first; --i) {
    const double f = s * e[i];
    const double b = c * e[i];
    r = std::sqrt(f * f + g * g);
    e[i + 1] = r;
    if (r == 0.0) {  // the matrix splits here
      d[i + 1] -= p;
      e[last] = 0.0;
      return;
    }
    s = f / r;
    c = g / r;
    g = d[i + 1] - p;
    r = (d[i] - g) * s + 2.0 * c * b;
    p = s * r;
    d[i + 1] = g + p;
    g = c * r - b;
    const double row = z[i + 1];
    z[i + 1] = s * z[i] + c * row;
    z[i] = c * z[i] - s * row;
  }
  d[first] -= p;
  e[first] = g;
  e[last] = 0.0;
}

}  // namespace

void gauss_quadrature(std::span<const double> diagonal, std::span<const double> off_diagonal,
                      QuadratureRule& rule) {
  const int size = static_cast<int>(diagonal.size());
  auto& d = rule.nodes;
  auto& z = rule.weights;
  auto& e = rule.scratch;
  d.assign(diagonal.begin(), diagonal.end());
  e.assign(off_diagonal.begin(), off_diagonal.end());
  e.push_back(0.0);
  z.assign(diagonal.size(), 0.0);
  z[0] = 1.0;

  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  for (int first = 0; first < size; ++first) {
    for (int sweep = 0;; ++sweep) {
      int last = first;
      while (last < size - 1 &&
             std::abs(e[last]) > kEpsilon * (std::abs(d[last]) + std::abs(d[last + 1]))) {
        ++last;
      }
      if (last == first) break;
      if (sweep == kMaxSweeps) throw NumericalError("quadrature", "QL iteration did not converge");
      ql_sweep(d, e, z, first, last);
    }
  }
  for (double& weight : z) weight *= weight;
}

}  // namespace isotherm::spectral::detail
