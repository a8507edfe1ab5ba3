#include "localize/evidence/multilateration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {
namespace {

constexpr std::size_t kMostChoices = 80;
constexpr std::size_t kRefined = 4;  // candidates that are worth a refinement

struct Candidate {
  Point position;
  double cost = 0.0;
};

// A known place and the distance to it.
struct Sphere {
  Point centre;
  double radius = 0.0;
};

// The two points where two circles meet, or the one nearest to both.
void intersect(const Sphere& a, const Sphere& b, std::vector<Candidate>& found) {
  const Eigen::Vector2d base = b.centre - a.centre;
  const double length = base.norm();
  if (length == 0.0) return;
  const Eigen::Vector2d along = base / length;
  const Eigen::Vector2d across(-along.y(), along.x());
  const double foot =
      (a.radius * a.radius - b.radius * b.radius + length * length) / (2.0 * length);
  const double height = std::sqrt(std::max(0.0, a.radius * a.radius - foot * foot));
  const Eigen::Vector2d middle = a.centre + foot * along;
  found.push_back({middle + height * across});
  if (height > 0.0) found.push_back({middle - height * across});
}

// The same for three spheres.
void intersect(const Sphere& a, const Sphere& b, const Sphere& c, std::vector<Candidate>& found) {
  constexpr double kCollinear = 1e-9;
  const Eigen::Vector3d base = b.centre - a.centre;
  const Eigen::Vector3d side = c.centre - a.centre;
  const double length = base.norm();
  if (length == 0.0) return;
  const Eigen::Vector3d x = base / length;
  const Eigen::Vector3d off = side - side.dot(x) * x;
  const double width = off.norm();
  if (width <= kCollinear * length) return;
  const Eigen::Vector3d y = off / width;
  const double first =
      (a.radius * a.radius - b.radius * b.radius + length * length) / (2.0 * length);
  const double second =
      (a.radius * a.radius - c.radius * c.radius + side.squaredNorm() - 2.0 * side.dot(x) * first) /
      (2.0 * width);
  const double height =
      std::sqrt(std::max(0.0, a.radius * a.radius - first * first - second * second));
  const Eigen::Vector3d middle = a.centre + first * x + second * y;
  const Eigen::Vector3d across = height * x.cross(y);
  found.push_back({middle + across});
  if (height > 0.0) found.push_back({middle - across});
}

// Where every d spheres meet, or those of an even sample of all choices of d.
std::vector<Candidate> meeting_points(const std::vector<Sphere>& spheres, int d) {
  std::vector<std::array<std::size_t, 3>> choices;
  for (std::size_t a = 0; a < spheres.size(); ++a) {
    for (std::size_t b = a + 1; b < spheres.size(); ++b) {
      if (d == 2) choices.push_back({a, b, b});
      for (std::size_t c = b + 1; d == 3 && c < spheres.size(); ++c) choices.push_back({a, b, c});
    }
  }
  std::vector<Candidate> found;
  const std::size_t stride = choices.size() / kMostChoices + 1;
  for (std::size_t k = 0; k < choices.size(); k += stride) {
    const auto [a, b, c] = choices[k];
    if (d == 2) {
      intersect(spheres[a], spheres[b], found);
    } else {
      intersect(spheres[a], spheres[b], spheres[c], found);
    }
  }
  return found;
}

// Possible places of the last node, the cheapest first. Of very many ranges an even
// sample makes them; all count in the cost.
std::vector<Candidate> candidates(const SmallNetwork& network, const Limits& limits) {
  constexpr std::size_t kMostSpheres = 24;
  const int self = static_cast<int>(network.positions.cols()) - 1;
  std::vector<Sphere> spheres;
  const std::size_t stride = (network.ranges.size() - 1) / kMostSpheres + 1;
  for (std::size_t k = 0; k < network.ranges.size(); k += stride) {
    const auto& range = network.ranges[k];
    const int other = range.from == self ? range.to : range.from;
    spheres.push_back({network.positions.col(other), range.distance});
  }
  auto result = meeting_points(spheres, static_cast<int>(network.positions.rows()));
  auto trial = network;
  for (auto& candidate : result) {
    trial.positions.col(self) = candidate.position;
    candidate.cost = place_cost(trial, limits);
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  return result;
}

}  // namespace

std::optional<Multilateration> multilaterate(SmallNetwork network, const Limits& limits) {
  constexpr int kIterations = 8;
  const auto self = network.positions.cols() - 1;
  network.fixed = static_cast<int>(self);
  if (network.ranges.empty()) return std::nullopt;
  std::vector<double> sigmas;
  for (const auto& range : network.ranges) sigmas.push_back(range.sigma);
  // Places nearer to each other than this are one.
  const double apart = 4.0 * lower_median(std::move(sigmas));

  std::vector<Candidate> seeds;
  for (const auto& candidate : candidates(network, limits)) {
    const bool fresh = std::none_of(seeds.begin(), seeds.end(), [&](const Candidate& seed) {
      return (seed.position - candidate.position).norm() < apart;
    });
    if (fresh) seeds.push_back(candidate);
    if (seeds.size() == kRefined) break;
  }
  for (auto& seed : seeds) {
    network.positions.col(self) = seed.position;
    fit_robustly(network, std::sqrt(limits.least()), kIterations);
    const double cost = place_cost(network, limits);
    if (cost < seed.cost) seed = {network.positions.col(self), cost};
  }
  if (seeds.empty()) return std::nullopt;
  const auto best =
      std::min_element(seeds.begin(), seeds.end(),
                       [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  Multilateration result{best->position, best->cost, best->position,
                         std::numeric_limits<double>::infinity()};
  for (const auto& seed : seeds) {
    if ((seed.position - best->position).norm() < apart) continue;
    if (seed.cost >= result.rival_cost) continue;
    result.rival = seed.position;
    result.rival_cost = seed.cost;
  }
  return result;
}

}  // namespace isotherm::network::detail
