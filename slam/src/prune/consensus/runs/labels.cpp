#include "prune/consensus/runs/labels.hpp"

#include <cmath>

namespace isotherm::slam::detail {

double LabelCounts::log_evidence() const {
  double sum = 0.0;
  for (const auto& [no, yes] : counts_) {
    sum += std::lgamma(1.0 + no) + std::lgamma(1.0 + yes) - std::lgamma(2.0 + no + yes);
  }
  return sum;
}

double LabelCounts::log_share(const Count& count, bool is_true) {
  return std::log((1.0 + count[is_true ? 1 : 0]) / (2.0 + count[0] + count[1]));
}

}  // namespace isotherm::slam::detail
