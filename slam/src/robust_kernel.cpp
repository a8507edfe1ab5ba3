#include "isotherm/slam/robust_kernel.hpp"

#include <algorithm>
#include <cmath>

namespace isotherm::slam {
namespace {

KernelValue huber(double width, double chi2) {
  if (chi2 <= width * width) return {chi2, 1.0};
  const double root = std::sqrt(chi2);
  return {2.0 * width * root - width * width, width / root};
}

KernelValue cauchy(double width, double chi2) {
  const double square = width * width;
  return {square * std::log1p(chi2 / square), 1.0 / (1.0 + chi2 / square)};
}

KernelValue dynamic_covariance_scaling(double width, double chi2) {
  if (chi2 <= width) return {chi2, 1.0};
  const double scale = 2.0 * width / (width + chi2);
  return {3.0 * width - 2.0 * width * scale, scale * scale};
}

}  // namespace

KernelValue evaluate_kernel(RobustKernel kernel, double width, double chi2) {
  // Rounding can leave a chi-squared of zero slightly negative.
  const double x = std::max(chi2, 0.0);
  switch (kernel) {
    case RobustKernel::huber:
      return huber(width, x);
    case RobustKernel::cauchy:
      return cauchy(width, x);
    case RobustKernel::dcs:
      return dynamic_covariance_scaling(width, x);
    case RobustKernel::none:
      break;
  }
  return {x, 1.0};
}

}  // namespace isotherm::slam
