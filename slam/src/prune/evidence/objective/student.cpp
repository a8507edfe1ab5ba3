#include "prune/evidence/objective/student.hpp"

#include <cmath>
#include <numbers>

namespace isotherm::slam::detail {

double log_student(double chi2, double nu, int dof) {
  if (nu >= kGaussian) return -0.5 * (chi2 + dof * std::log(2.0 * std::numbers::pi));
  return std::lgamma(0.5 * (nu + dof)) - std::lgamma(0.5 * nu) -
         0.5 * dof * std::log(nu * std::numbers::pi) - 0.5 * (nu + dof) * std::log1p(chi2 / nu);
}

double student_weight(double chi2, double nu, int dof) {
  return nu >= kGaussian ? 1.0 : (nu + dof) / (nu + chi2);
}

double laplace_deficit(double nu, int dof) {
  if (nu >= kGaussian) return 0.0;
  return std::lgamma(0.5 * nu) - std::lgamma(0.5 * (nu + dof)) +
         0.5 * dof * std::log(0.5 * (nu + dof));
}

}  // namespace isotherm::slam::detail
