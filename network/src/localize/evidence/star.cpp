#include "localize/evidence/star.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "localize/constants.hpp"
#include "localize/problem/geman_mcclure.hpp"

namespace isotherm::network::detail {
namespace {

constexpr std::size_t kMostArms = 24;
constexpr std::size_t kMostChoices = 80;
constexpr std::size_t kRefined = 4;  // places that are worth a refinement

struct Candidate {
  Point position;
  double cost = 0.0;
};

// The two points where two circles meet, or the one nearest to both.
void intersect(const Arm& a, const Arm& b, std::vector<Point>& found) {
  const Eigen::Vector2d base = b.end - a.end;
  const double length = base.norm();
  if (length == 0.0) return;
  const Eigen::Vector2d along = base / length;
  const Eigen::Vector2d across(-along.y(), along.x());
  const double foot =
      (a.distance * a.distance - b.distance * b.distance + length * length) / (2.0 * length);
  const double height = std::sqrt(std::max(0.0, a.distance * a.distance - foot * foot));
  const Eigen::Vector2d middle = a.end + foot * along;
  found.emplace_back(middle + height * across);
  if (height > 0.0) found.emplace_back(middle - height * across);
}

// The same for three arms.
void intersect(const Arm& a, const Arm& b, const Arm& c, std::vector<Point>& found) {
  constexpr double kCollinear = 1e-9;
  const Eigen::Vector3d base = b.end - a.end;
  const Eigen::Vector3d side = c.end - a.end;
  const double length = base.norm();
  if (length == 0.0) return;
  const Eigen::Vector3d x = base / length;
  const Eigen::Vector3d off = side - side.dot(x) * x;
  const double width = off.norm();
  if (width <= kCollinear * length) return;
  const Eigen::Vector3d y = off / width;
  const double first =
      (a.distance * a.distance - b.distance * b.distance + length * length) / (2.0 * length);
  const double second = (a.distance * a.distance - c.distance * c.distance + side.squaredNorm() -
                         2.0 * side.dot(x) * first) /
                        (2.0 * width);
  const double height =
      std::sqrt(std::max(0.0, a.distance * a.distance - first * first - second * second));
  const Eigen::Vector3d middle = a.end + first * x + second * y;
  const Eigen::Vector3d across = height * x.cross(y);
  found.emplace_back(middle + across);
  if (height > 0.0) found.emplace_back(middle - across);
}

// Where every d arms meet, or those of an even sample of all choices of d.
std::vector<Point> meeting_points(const std::vector<Arm>& arms, int d) {
  std::vector<std::array<std::size_t, 3>> choices;
  const std::size_t step = arms.empty() ? 1 : (arms.size() - 1) / kMostArms + 1;
  for (std::size_t a = 0; a < arms.size(); a += step) {
    for (std::size_t b = a + step; b < arms.size(); b += step) {
      if (d == 2) choices.push_back({a, b, b});
      for (std::size_t c = b + step; d == 3 && c < arms.size(); c += step) {
        choices.push_back({a, b, c});
      }
    }
  }
  std::vector<Point> found;
  const std::size_t stride = choices.size() / kMostChoices + 1;
  for (std::size_t k = 0; k < choices.size(); k += stride) {
    const auto [a, b, c] = choices[k];
    if (d == 2) {
      intersect(arms[a], arms[b], found);
    } else {
      intersect(arms[a], arms[b], arms[c], found);
    }
  }
  return found;
}

// A step of Gauss and Newton's on Geman and McClure's loss, as wide as ranges cost anything times
// `factor`.
Point step(const Star& star, const Point& place, double factor) {
  constexpr double kTiny = 1e-9;  // of the information: it may not fix the place
  const auto d = place.size();
  Block matrix = Block::Zero(d, d);
  Point gradient = Point::Zero(d);
  for (const auto& arm : star.arms) {
    const Point way = place - arm.end;
    const double length = way.norm();
    if (length == 0.0) continue;
    const double residual = (length - arm.distance) / arm.sigma;
    const GemanMcClure kernel{factor * std::sqrt(arm.cost.anything)};
    const double weight = kernel.weight(residual * residual);
    const Point slope = way / (length * arm.sigma);
    matrix += weight * slope * slope.transpose();
    gradient += weight * residual * slope;
  }
  matrix.diagonal().array() += kTiny * matrix.trace() + 1e-300;
  return matrix.llt().solve(gradient);
}

// The best place on the way to the nearest minimum, of a loss that narrows.
Candidate descend(const Star& star, const Candidate& from) {
  constexpr std::array<double, 8> kWidths = {4.0, 4.0, 2.0, 2.0, 1.0, 1.0, 1.0, 1.0};
  Candidate best = from;
  Point place = from.position;
  for (const double width : kWidths) {
    place -= step(star, place, width);
    const double cost = star.cost(place);
    if (cost < best.cost) best = {place, cost};
  }
  return best;
}

// The cheapest places, one of those that are nearer to each other than `apart`.
std::vector<Candidate> candidates(const Star& star, double apart) {
  std::vector<Candidate> all;
  for (auto& point : meeting_points(star.arms, static_cast<int>(star.arms.front().end.size()))) {
    all.push_back({point, star.cost(point)});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  std::vector<Candidate> fresh;
  for (const auto& candidate : all) {
    const bool is_fresh = std::none_of(fresh.begin(), fresh.end(), [&](const Candidate& other) {
      return distance_between(other.position, candidate.position) < apart;
    });
    if (is_fresh) fresh.push_back(candidate);
    if (fresh.size() == kRefined) break;
  }
  return fresh;
}

}  // namespace

Arm arm_of(const RangePair& pair, const Evidence& evidence, const Point& end) {
  return {end, pair.distance, pair.sigma, evidence.cost_of(pair.sigma)};
}

double Star::cost(const Point& place) const {
  double sum = 0.0;
  for (const auto& arm : arms) sum += arm.cost(arm.residual(place));
  if (absence == nullptr) return sum;
  for (const auto& stranger : strangers) sum += absence->cost(distance_between(stranger, place));
  return sum;
}

int Star::agreeing(const Point& place, double gate) const {
  return static_cast<int>(std::count_if(arms.begin(), arms.end(), [&](const Arm& arm) {
    return std::pow(arm.residual(place), 2) <= gate;
  }));
}

Star star(const RangeProblem& problem, const Evidence& evidence, const Placement& placement,
          Index node, const std::vector<bool>& usable) {
  Star result;
  for (const auto& [vertex, edge] : problem.pair_graph.neighbours(node)) {
    if (!placement.placed[vertex] || (!usable.empty() && !usable[edge])) continue;
    result.arms.push_back(arm_of(problem.pairs[edge], evidence, placement.positions.col(vertex)));
  }
  return result;
}

std::optional<Multilateration> multilaterate(const Star& star) {
  if (star.arms.empty()) return std::nullopt;
  std::vector<double> sigmas;
  for (const auto& arm : star.arms) sigmas.push_back(arm.sigma);
  const double apart = kApart * lower_median(std::move(sigmas));
  auto places = candidates(star, apart);
  if (places.empty()) return std::nullopt;
  for (auto& place : places) place = descend(star, place);
  const auto best =
      std::min_element(places.begin(), places.end(),
                       [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
  Multilateration result{best->position, best->cost, best->position,
                         std::numeric_limits<double>::infinity()};
  for (const auto& place : places) {
    if ((place.position - best->position).norm() < apart || place.cost >= result.rival_cost) {
      continue;
    }
    result.rival = place.position;
    result.rival_cost = place.cost;
  }
  return result;
}

}  // namespace isotherm::network::detail
