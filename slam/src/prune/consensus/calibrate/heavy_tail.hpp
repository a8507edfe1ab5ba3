#pragma once

#include <vector>

namespace isotherm::slam::detail {

/// How far out chi-squared of a correct loop lies, by Student's distribution.
struct Tail {
  double quantile = 0.0;  ///< of chi-squared; exceeded with the probability asked for
  double factor = 1.0;    ///< how many times as far as Gaussian errors of the same median; >= 1
};

/// The tail of errors of which `chi2`, not empty, has `dof` degrees of freedom.
///
/// With Student's distribution chi-squared over dof is distributed as F with dof and nu
/// degrees of freedom, times a factor. nu is found from the ratio of the 90 % quantile
/// and the median, which few false loops hardly change. A few values could have it by
/// chance where tails are heavier: it is taken two deviations larger.
Tail student_tail(const std::vector<double>& chi2, int dof, double probability);

}  // namespace isotherm::slam::detail
