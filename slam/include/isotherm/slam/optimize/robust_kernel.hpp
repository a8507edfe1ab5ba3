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
  sc,      ///< switchable constraints: N. Suenderhauf, P. Protzel, "Switchable
           ///< Constraints for Robust Pose Graph SLAM", IROS 2012; w x / (w + x)
  gnc,     ///< truncated least squares min(x, w) by graduated non-convexity: H. Yang
           ///< et al., "Graduated Non-Convexity for Robust Spatial Perception", RA-L 2020
  gnc_gm,  ///< Geman-McClure w x / (w + x) by graduated non-convexity
};

constexpr std::array<EnumName<RobustKernel>, 7> enum_names(RobustKernel) {
  return {{{RobustKernel::none, "none"},
           {RobustKernel::huber, "huber"},
           {RobustKernel::cauchy, "cauchy"},
           {RobustKernel::dcs, "dcs"},
           {RobustKernel::sc, "sc"},
           {RobustKernel::gnc, "gnc"},
           {RobustKernel::gnc_gm, "gnc-gm"}}};
}

/// Cost rho(chi2) and its derivative, the weight of the constraint.
struct KernelValue {
  double cost = 0.0;
  double weight = 1.0;
};

/// The width a kernel has in its paper: 1 (for Huber 1.345, 95 % efficiency), and
/// for graduated non-convexity the 0.999 quantile of chi-squared with `dof`
/// degrees of freedom (GTSAM has 0.99, which costs one correct loop in a hundred).
double default_kernel_width(RobustKernel kernel, int dof);

/// Chi-squared above which a constraint counts for less than half of what it
/// measures: the switch of SC and the scale of DCS fall below 0.5 there, the
/// weights of the other kernels too. Infinity without a kernel.
double kernel_threshold(RobustKernel kernel, double width);

/// The kernel's value at `chi2` >= 0 for a width > 0. Huber and Cauchy measure
/// the width in units of sqrt(chi2); DCS (its Phi), SC (the inverse variance of a
/// switch's prior) and GNC (the largest chi-squared of a good constraint) in units
/// of chi2.
///
/// DCS scales a constraint's information by s^2, s = min(1, 2 Phi / (Phi + chi2)),
/// as published. The cost whose derivative that is, 3 Phi - 4 Phi^2 / (Phi + chi2)
/// beyond chi2 = Phi, levels off at 3 Phi.
KernelValue evaluate_kernel(RobustKernel kernel, double width, double chi2);

}  // namespace isotherm::slam
