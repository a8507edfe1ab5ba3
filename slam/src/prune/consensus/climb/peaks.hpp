#pragma once

#include <algorithm>
#include <vector>

#include "prune/consensus/objective/objective.hpp"

namespace isotherm::slam::detail {

/// Peaks that climbs have ended at, and where they passed on the way.
template <class Pose>
class Peaks {
 public:
  /// Whether no climb before has ended higher.
  bool none_above(double evidence) const {
    return std::ranges::all_of(peaks_, [&](const auto& peak) { return peak.evidence <= evidence; });
  }

  /// The present climb was there.
  void pass(const Explanation<Pose>& now);

  /// The peak of an earlier climb that passed there: with the same loops at about the same scales,
  /// and not worse. None where none did.
  const Explanation<Pose>* beyond(const Explanation<Pose>& now) const;

  /// The present climb ends, at a peak of its own or at one that beyond() told.
  void end_at(const Explanation<Pose>& own) { peaks_.push_back(own); }
  const Explanation<Pose>& end_at_known(const Explanation<Pose>& peak);

 private:
  struct Passed {
    std::vector<bool> accepted;
    CovarianceScale scale;
    double evidence;
    std::size_t peak;  // its number; of the present climb that of the next
  };

  std::vector<Explanation<Pose>> peaks_;
  std::vector<Passed> passed_;
};

extern template class Peaks<Pose2>;
extern template class Peaks<Pose3>;

}  // namespace isotherm::slam::detail
