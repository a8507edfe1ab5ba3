#pragma once

#include <vector>

#include "prune/consensus/estimate/estimate.hpp"

namespace isotherm::slam::detail {

/// False loops come in runs: where a place looks like another, so do their neighbours. Of each
/// loop, the one before it in its run.
template <class Pose>
class Runs {
 public:
  static constexpr Index kNone = -1;

  /// The nearest of the loops before it with both ends within `window` vertices.
  Runs(const ReducedGraph<Pose>& graph, Index window);

  Index before(Index loop) const { return before_[loop]; }
  bool copied(Index loop) const { return copied_[loop]; }

  /// log N(z; what the loop before predicts), one a loop; of those without one, 0.
  std::vector<double> log_density(const ReducedGraph<Pose>& graph, const CovarianceScale& scale,
                                  int threads = 1) const;

 private:
  std::vector<Index> before_;
  std::vector<bool> copied_;
};

extern template class Runs<Pose2>;
extern template class Runs<Pose3>;

}  // namespace isotherm::slam::detail
