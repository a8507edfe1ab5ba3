#pragma once

#include <vector>

namespace isotherm {

/// The middle one, or the mean of the middle two; `values` is not empty. O(n).
double median(std::vector<double> values);

/// The one with this share, 0 <= share < 1, of all `values` before it in ascending order,
/// rounded down; `values` is not empty. O(n). @throws InvalidArgument for another share
double quantile(std::vector<double> values, double share);

/// The value that a chi-squared variable with `dof` degrees of freedom stays
/// below with the given probability, 0 <= probability < 1.
/// @throws InvalidArgument outside these ranges or for dof < 1.
double chi_squared_quantile(double probability, int dof);

/// The probability that a chi-squared variable with `dof` degrees of freedom
/// exceeds `value` >= 0.
/// @throws InvalidArgument for a negative or NaN value or for dof < 1.
double chi_squared_upper_tail(double value, int dof);

/// The value that the ratio of two independent chi-squared variables, each over its
/// degrees of freedom, stays below with the given probability (Fisher's F distribution).
/// @throws InvalidArgument for a probability outside [0, 1) or degrees that are not positive.
double f_quantile(double probability, double dof, double dof_below);

}  // namespace isotherm
