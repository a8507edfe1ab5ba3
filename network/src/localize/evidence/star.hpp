#pragma once

#include <optional>
#include <vector>

#include "localize/evidence/evidence.hpp"
#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// A range of a node to another one that has a place.
struct Arm {
  Point end;
  double distance = 0.0;
  double sigma = 1.0;
  RangeCost cost;

  /// (distance between the ends - range) / sigma.
  double residual(const Point& place) const {
    return (distance_between(end, place) - distance) / sigma;
  }
};

/// That of a pair whose other end is here.
Arm arm_of(const RangePair& pair, const Evidence& evidence, const Point& end);

/// What speaks for and against places of one node.
struct Star {
  std::vector<Arm> arms;
  std::vector<Point> strangers = {};  ///< places of nodes that it has no range to
  const Absence* absence = nullptr;   ///< what that costs; null: nothing

  double cost(const Point& place) const;

  /// How many ranges deviate by no more than sqrt(gate) standard deviations.
  int agreeing(const Point& place, double gate) const;
};

/// The ranges to placed neighbours; only the `usable` pairs, if these are given.
Star star(const RangeProblem& problem, const Evidence& evidence, const Placement& placement,
          Index node, const std::vector<bool>& usable = {});

/// The best place of a node, and the best one elsewhere.
struct Multilateration {
  Point position;
  double cost = 0.0;
  Point rival;
  double rival_cost = 0.0;  ///< infinite if there is none

  double margin() const { return rival_cost - cost; }
};

/// Every d of the ranges (an even sample where there are many) meet in two places; the cheapest are
/// refined and compared. Nothing if there are fewer than d ranges or their far ends do not span a
/// line (plane, in space).
std::optional<Multilateration> multilaterate(const Star& star);

}  // namespace isotherm::network::detail
