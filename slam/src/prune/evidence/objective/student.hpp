#pragma once

namespace isotherm::slam::detail {

/// Degrees of freedom beyond which Student's distribution is taken as the normal one.
inline constexpr double kGaussian = 1e6;

/// log of Student's density in `dof` dimensions with `nu` degrees of freedom, at Mahalanobis
/// distance squared `chi2`, times |Sigma|^(1/2).
double log_student(double chi2, double nu, int dof);

/// The factor on the information of a residual by which a normal density has the slope of
/// Student's there: (nu + dof) / (nu + chi2).
double student_weight(double chi2, double nu, int dof);

/// By how much Laplace's approximation at the peak, with the curvature of student_weight(),
/// falls short of the mass of Student's density: a log, >= 0.
double laplace_deficit(double nu, int dof);

}  // namespace isotherm::slam::detail
