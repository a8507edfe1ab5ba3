#include "isotherm/slam/optimize/robust_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "isotherm/base/statistics.hpp"

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

KernelValue geman_mcclure(double width, double chi2) {
  const double share = width / (width + chi2);
  return {share * chi2, share * share};
}

KernelValue truncated(double width, double chi2) {
  return chi2 <= width ? KernelValue{chi2, 1.0} : KernelValue{width, 0.0};
}

}  // namespace

double default_kernel_width(RobustKernel kernel, int dof) {
  switch (kernel) {
    case RobustKernel::huber:
      return 1.345;
    case RobustKernel::gnc:
    case RobustKernel::gnc_gm:
      return chi_squared_quantile(0.999, dof);
    default:
      return 1.0;
  }
}

double kernel_threshold(RobustKernel kernel, double width) {
  switch (kernel) {
    case RobustKernel::none:
      break;
    case RobustKernel::huber:
      return 4.0 * width * width;
    case RobustKernel::cauchy:
      return width * width;
    case RobustKernel::dcs:
      return 3.0 * width;
    case RobustKernel::sc:
    case RobustKernel::gnc:
      return width;
    case RobustKernel::gnc_gm:
      return (std::sqrt(2.0) - 1.0) * width;
  }
  return std::numeric_limits<double>::infinity();
}

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
    case RobustKernel::sc:
    case RobustKernel::gnc_gm:
      return geman_mcclure(width, x);
    case RobustKernel::gnc:
      return truncated(width, x);
    case RobustKernel::none:
      break;
  }
  return {x, 1.0};
}

}  // namespace isotherm::slam
