#include "localize/problem/absence.hpp"

#include <algorithm>
#include <cmath>

#include "localize/constants.hpp"
#include "localize/problem/point_grid.hpp"

namespace isotherm::network::detail {
namespace {

double longest_of_most(const RangeProblem& problem, const std::vector<bool>& trusted) {
  std::vector<double> distances;
  for (std::size_t p = 0; p < problem.pairs.size(); ++p) {
    if (trusted[p]) distances.push_back(problem.pairs[p].distance);
  }
  if (distances.empty()) return 0.0;
  const auto last = static_cast<double>(distances.size() - 1);
  const auto nth = distances.begin() + static_cast<std::ptrdiff_t>(kMostRanges * last);
  std::nth_element(distances.begin(), nth, distances.end());
  return *nth;
}

enum class Link { none, trusted, suspected };

Link link_between(const RangeProblem& problem, const std::vector<bool>& trusted, Index a, Index b) {
  for (const auto& [vertex, edge] : problem.pair_graph.neighbours(a)) {
    if (vertex == b) return trusted[edge] ? Link::trusted : Link::suspected;
  }
  return Link::none;
}

}  // namespace

// Pairs by distance, with and without a range.
class Absence::Counts {
 public:
  Counts(const RangeProblem& problem, const std::vector<bool>& trusted)
      : problem_(problem),
        trusted_(trusted),
        end_(kAbsenceEnd * longest_of_most(problem, trusted)),
        with_(kAbsenceBins, 0.0),
        without_(kAbsenceBins, 0.0) {}

  double end() const { return end_; }

  bool matters(Index a, Index b) const { return !problem_.is_anchor[a] || !problem_.is_anchor[b]; }

  void add(Index a, Index b, double distance) {
    if (!(distance < end_) || !matters(a, b)) return;
    const auto bin =
        std::min(kAbsenceBins - 1, static_cast<std::size_t>(distance / end_ * kAbsenceBins));
    switch (link_between(problem_, trusted_, a, b)) {
      case Link::none:
        without_[bin] += 1.0;
        break;
      case Link::trusted:
        with_[bin] += 1.0;
        break;
      case Link::suspected:
        break;
    }
  }

  Absence curve() const {
    Absence result;
    result.bin_ = end_ / static_cast<double>(kAbsenceBins);
    for (std::size_t k = 0; k < kAbsenceBins; ++k) {
      const double without = without_[k] + kGranted;
      const double chance = without / (without + with_[k]);
      result.costs_.push_back(std::max(0.0, -2.0 * std::log(2.0 * std::max(kLeastAbsent, chance))));
      if (result.costs_.back() > 0.0) result.reach_ = result.bin_ * static_cast<double>(k + 1);
    }
    return result;
  }

 private:
  const RangeProblem& problem_;
  const std::vector<bool>& trusted_;
  double end_;
  std::vector<double> with_;
  std::vector<double> without_;
};

Absence Absence::learn(const RangeProblem& problem, const std::vector<bool>& trusted,
                       const Placement& placement) {
  Counts counts(problem, trusted);
  if (!(counts.end() > 0.0) || placed_count(placement) == 0) return {};
  const auto wanted = [&](Index a, Index b) { return counts.matters(a, b); };
  for (const auto& [a, b] : near_nodes(placement, counts.end(), wanted)) {
    counts.add(a, b, distance_of(placement, a, b));
  }
  return counts.curve();
}

double Absence::cost(double distance) const { return at(distance).first; }

double Absence::slope(double distance) const { return at(distance).second; }

std::pair<double, double> Absence::at(double distance) const {
  if (distance >= reach_) return {0.0, 0.0};
  const double at = distance / bin_ - 0.5;
  if (at <= 0.0) return {costs_.front(), 0.0};
  const auto k = static_cast<std::size_t>(at);
  const double next = k + 1 < costs_.size() ? costs_[k + 1] : 0.0;
  const double share = at - static_cast<double>(k);
  return {(1.0 - share) * costs_[k] + share * next, (next - costs_[k]) / bin_};
}

}  // namespace isotherm::network::detail
