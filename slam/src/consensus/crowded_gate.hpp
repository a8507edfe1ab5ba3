#pragma once

#include <vector>

namespace isotherm::slam::detail {

/// Where the chi-squared of true loops end and those of false ones begin: at most `gate`.
///
/// On a logarithmic scale true loops become fewer towards the gate and false ones more. If
/// far more lie just beyond the gate than in the emptiest octave below it, that octave's
/// middle, otherwise `gate`. O(n log n) for n loops.
double crowded_gate(std::vector<double> chi2, double gate);

}  // namespace isotherm::slam::detail
