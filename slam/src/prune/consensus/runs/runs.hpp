#pragma once

#include <vector>

#include "prune/consensus/estimate/reduced_graph.hpp"
#include "prune/consensus/runs/labels.hpp"

namespace isotherm::slam::detail {

/// Loops come in runs: where a place looks like another, so do their neighbours. Of each loop, the
/// one before it in its run.
template <class Pose>
class Runs {
 public:
  static constexpr Index kNone = -1;

  /// The nearest of the loops before it with both ends within `window` vertices.
  Runs(const ReducedGraph<Pose>& graph, Index window);

  Index before(Index loop) const { return before_[loop]; }
  bool copied(Index loop) const { return copied_[loop]; }

  /// The one before it that tells whether it is true; none of a copy, which is no draw of its own.
  Index leader(Index loop) const { return copied_[loop] ? kNone : before_[loop]; }

  /// Of all that have one.
  std::vector<Index> leaders() const;

  /// What one is that none leads.
  LabelCounts::Alone alone(Index loop) const {
    return copied_[loop] ? LabelCounts::kCopy : LabelCounts::kFirst;
  }

  /// Whether none leads it, and it leads none.
  bool by_itself(Index loop) const { return before_[loop] == kNone && followers_[loop].empty(); }

  /// Those that it leads.
  const std::vector<Index>& followers(Index loop) const { return followers_[loop]; }

  /// How many are true where each is with such a probability.
  template <class Probabilities>
  LabelCounts labels(const Probabilities& is_true) const {
    LabelCounts counts;
    for (std::size_t k = 0; k < before_.size(); ++k) {
      const Index led_by = leader(static_cast<Index>(k));
      if (led_by == kNone) {
        counts.add(alone(static_cast<Index>(k)), is_true[k]);
      } else {
        counts.add_next(is_true[led_by], is_true[k]);
      }
    }
    return counts;
  }

 private:
  std::vector<Index> before_;
  std::vector<bool> copied_;
  std::vector<std::vector<Index>> followers_;
};

extern template class Runs<Pose2>;
extern template class Runs<Pose3>;

}  // namespace isotherm::slam::detail
