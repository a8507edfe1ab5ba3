#pragma once

#include <vector>

namespace isotherm::slam::detail {

/// How well loops with neighbouring ends agree.
struct Agreement {
  double most_chi2 = 0.0;       ///< true ones agree at least so well
  double alike_fraction = 0.0;  ///< of the pairs of false ones that do by chance
};

/// From the chi-squared of pairs of neighbouring loops that are all accepted, or all
/// refuted. Accepted ones may agree far better than `gate`, where the file overstates their
/// errors: the limit is then a few times what nearly all of them keep to, which a few false
/// ones among them hardly change. The fraction is a Beta posterior, a fifth without data.
Agreement learn_agreement(std::vector<double> accepted, const std::vector<double>& refuted,
                          double gate);

}  // namespace isotherm::slam::detail
