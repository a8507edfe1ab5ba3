#pragma once

#include <array>

#include "isotherm/base/options.hpp"

namespace isotherm::slam {

/// How the cost of one constraint grows with its chi-squared x.
enum class RobustKernel {
  none,    ///< x
  huber,   ///< x up to w^2, then 2 w sqrt(x) - w^2 (P. Huber, 1964)
  cauchy,  ///< w^2 log(1 + x / w^2)
  dcs,     ///< dynamic covariance scaling: P. Agarwal et al., "Robust Map
           ///< Optimization using Dynamic Covariance Scaling", ICRA 2013, eq. 15-16
};

constexpr std::array<EnumName<RobustKernel>, 4> enum_names(RobustKernel) {
  return {{{RobustKernel::none, "none"},
           {RobustKernel::huber, "huber"},
           {RobustKernel::cauchy, "cauchy"},
           {RobustKernel::dcs, "dcs"}}};
}

/// Cost rho(chi2) and its derivative, the weight of the constraint.
struct KernelValue {
  double cost = 0.0;
  double weight = 1.0;
};

/// The kernel's value at `chi2` >= 0 for a width > 0. Huber and Cauchy measure
/// the width in units of sqrt(chi2), DCS (its Phi) in units of chi2.
///
/// DCS scales a constraint's information by s^2, s = min(1, 2 Phi / (Phi + chi2)),
/// as published. The cost whose derivative that is, 3 Phi - 4 Phi^2 / (Phi + chi2)
/// beyond chi2 = Phi, levels off at 3 Phi.
KernelValue evaluate_kernel(RobustKernel kernel, double width, double chi2);

}  // namespace isotherm::slam
