#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "isotherm/spectral/edges/threshold.hpp"

namespace isotherm::spectral::detail {

/// A threshold with the mean of |2 p - 1| as its separation: how decided the probabilities of the
/// edges are.
Threshold decided_threshold(double value, const std::vector<double>& truth);

/// The threshold of any score where something else has told how likely each edge is a true one:
/// that of the highest F to be expected (threshold_of_best_f()), of scores at which one edge in
/// five is false at least.
Threshold control_threshold(const std::vector<double>& scores, const std::vector<double>& truth);

/// What a score is worth that prunes more true edges than false ones; nothing of any other.
std::vector<std::string> doubts_of(const std::vector<double>& scores,
                                   const std::vector<double>& truth, const Threshold& threshold,
                                   std::string_view method);

}  // namespace isotherm::spectral::detail
