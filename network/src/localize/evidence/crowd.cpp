#include "localize/evidence/crowd.hpp"

#include <vector>

#include "localize/constants.hpp"

namespace isotherm::network::detail {

Crowd::Crowd(const RangeProblem& problem, const Placement& placement, const Absence& absence)
    : problem_(problem), absence_(absence), grid_(absence.reach()) {
  for (Index v = 0; v < problem.nodes && absence.reach() > 0.0; ++v) {
    if (placement.placed[v]) grid_.insert(v, placement.positions.col(v));
  }
}

void Crowd::add_strangers(Star& star, Index node, const std::vector<bool>& among) const {
  if (!(absence_.reach() > 0.0) || star.arms.empty()) return;
  // Where most neighbours are. Places far from there have too few strangers, which makes them
  // look better than they are, not worse.
  Point middle(problem_.dimension);
  for (int i = 0; i < problem_.dimension; ++i) {
    std::vector<double> values;
    for (const auto& arm : star.arms) values.push_back(arm.end[i]);
    middle[i] = lower_median(std::move(values));
  }
  const double radius = kStrangersAround * absence_.reach();
  grid_.visit_near(middle, radius, [&](Index other, const Point& position) {
    if (other == node || !among[other] || distance_between(position, middle) > radius) return;
    if (!has_range(problem_, node, other)) star.strangers.push_back(position);
  });
  star.absence = &absence_;
}

double Crowd::absence_cost(Index node, const Point& place, const std::vector<bool>& among) const {
  double cost = 0.0;
  if (!(absence_.reach() > 0.0)) return cost;
  grid_.visit_near(place, absence_.reach(), [&](Index other, const Point& position) {
    const double distance = distance_between(place, position);
    if (distance >= absence_.reach() || other == node || !among[other]) return;
    if (!has_range(problem_, node, other)) cost += absence_.cost(distance);
  });
  return cost;
}

double absence_cost(const RangeProblem& problem, const Absence& absence,
                    const Placement& placement) {
  const Crowd crowd(problem, placement, absence);
  double twice = 0.0;
  for (Index v = 0; v < problem.nodes; ++v) {
    if (!placement.placed[v]) continue;
    twice += crowd.absence_cost(v, placement.positions.col(v), placement.placed);
  }
  return 0.5 * twice;
}

}  // namespace isotherm::network::detail
