#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "prune/consensus/climb/position.hpp"

namespace isotherm::slam::detail {

/// What a climb does when nothing else is left: from where it stands, with edges of odometry that
/// slip otherwise.
template <class Pose>
class SlipTrials {
 public:
  using Selection = typename Position<Pose>::Selection;

  /// Moves of the climb: accept or drop loops, whether there was any; and learn all that can be of
  /// those accepted.
  struct Moves {
    std::function<bool()> shift;
    std::function<void()> settle;
  };

  /// `at` must outlive this object. What is beyond doubt has these log odds.
  SlipTrials(Position<Pose>& at, Moves moves, double decisive)
      : at_(at), moves_(std::move(moves)), decisive_(decisive) {}

  /// Whether slips gain that are beyond doubt were all loops as accurate as most, and odometry in
  /// all coordinates.
  bool as_if_accurate();

  /// Whether it gains of any run of rejected loops that it is true: they may be refuted each alone,
  /// and tell a slip together. The likeliest first.
  bool for_rejected_runs();

  /// What explains best that such a run is true, of those of which it does not gain.
  std::vector<Explanation<Pose>> doubted() && { return std::move(doubted_); }

 private:
  bool for_run(const Selection& loops);
  std::vector<Selection> rejected_runs() const;

  Position<Pose>& at_;
  Moves moves_;
  double decisive_;
  std::vector<Explanation<Pose>> doubted_;
};

extern template class SlipTrials<Pose2>;
extern template class SlipTrials<Pose3>;

}  // namespace isotherm::slam::detail
