#pragma once

#include <span>
#include <vector>

#include "prune/consensus/runs/runs.hpp"

namespace isotherm::slam::detail {

/// How false loops come to be. One joins any pair of poses by chance; or a pair that is near, as a
/// true one does, and measures it wrong: of the share of those nothing is known but that few are
/// expected (kFalseByChance). Or, kFalseFollowing of them, one after a false one in its run follows
/// that: where one place is taken for another so are its neighbours, and what they measure follows
/// from the one before as a true one's does. Neither that a loop joins what is near nor that it
/// agrees with the one before is a sign then that it is true.
struct FalseLoops {
  /// log of the share of those of the right place among those that follow none, and of the others.
  double log_right = 0.0;
  double log_chance = 0.0;
  /// Of each loop after a false one, log of how much likelier it is for that; 0 where it or the one
  /// before is `accepted`, or none is before it.
  std::vector<double> log_follows;
  /// log of how much likelier those that are not accepted are than by chance, with the share
  /// integrated out; a lower bound (variational Bayes).
  double log_evidence = 0.0;

  /// log of how much likelier than by chance a false loop is that follows none.
  double log_alone(double log_place) const;
};

/// `log_led`: of each loop, log of the density of what it measures as it follows from the one
/// before, over that of near pairs: around it, or by chance where that is more. `log_place`: of how
/// much likelier than by chance it is as a wrong measurement of the right place.
template <class Pose>
FalseLoops false_loops(const Runs<Pose>& runs, const std::vector<bool>& accepted,
                       std::span<const double> log_led, std::span<const double> log_place);

}  // namespace isotherm::slam::detail
