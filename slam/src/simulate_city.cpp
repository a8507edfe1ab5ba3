#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>
#include <unordered_set>

#include "isotherm/base/error.hpp"
#include "isotherm/base/random.hpp"
#include "isotherm/slam/odometry.hpp"
#include "isotherm/slam/simulate.hpp"

namespace isotherm::slam {
namespace {

// A loop closure joins poses at least this many steps apart.
constexpr Index kLoopGap = 10;

void require_positive(const char* name, double value) {
  if (!(std::isfinite(value) && value > 0.0)) {
    throw InvalidArgument(name, "must be finite and positive");
  }
}

struct Cell {
  std::int64_t x = 0;
  std::int64_t y = 0;
  friend bool operator==(const Cell&, const Cell&) = default;
};

// The path on the integer lattice, with the heading (quarter turns) in which
// each pose is about to leave.
struct LatticePath {
  std::vector<Cell> cells;
  std::vector<int> headings;
};

constexpr Cell kSteps[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};

Cell ahead(const Cell& cell, int heading) {
  return {cell.x + kSteps[heading].x, cell.y + kSteps[heading].y};
}

// Half the width of the city. The streets inside are about twice as long as the
// path, so that places are met again without the walk staying in one corner.
std::int64_t half_width(const CityOptions& options) {
  const double side = std::sqrt(static_cast<double>(options.poses * options.block));
  const auto blocks = static_cast<std::int64_t>(side / (2.0 * static_cast<double>(options.block)));
  return options.block * std::max<std::int64_t>(1, blocks);
}

LatticePath drive(const CityOptions& options, Random& random) {
  const std::int64_t limit = half_width(options);
  LatticePath path;
  Cell cell;
  int heading = 0;
  for (std::int64_t k = 0; k < options.poses; ++k) {
    if (k > 0) cell = ahead(cell, heading);
    if (cell.x % options.block == 0 && cell.y % options.block == 0) {
      // Straight on, left or right; never back, never out of the city.
      const auto outside = [&](int direction) {
        const Cell next = ahead(cell, direction);
        return std::abs(next.x) > limit || std::abs(next.y) > limit;
      };
      int turned = heading;
      do {
        const auto choice = random.index(4);  // straight on twice as often
        turned = (heading + (choice < 2 ? 0 : choice == 2 ? 1 : 3)) % 4;
      } while (outside(turned));
      heading = turned;
    }
    path.cells.push_back(cell);
    path.headings.push_back(heading);
  }
  return path;
}

std::vector<Pose2> exact_poses(const LatticePath& path) {
  std::vector<Pose2> poses;
  poses.reserve(path.cells.size());
  for (std::size_t k = 0; k < path.cells.size(); ++k) {
    poses.emplace_back(static_cast<double>(path.cells[k].x), static_cast<double>(path.cells[k].y),
                       wrap_angle(path.headings[k] * 0.5 * std::numbers::pi));
  }
  const Pose2 to_origin = poses.front().inverse();
  for (auto& pose : poses) pose = to_origin * pose;
  return poses;
}

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    return static_cast<std::size_t>(cell.x) * 0x9E3779B97F4A7C15u ^
           static_cast<std::size_t>(cell.y) * 0xC2B2AE3D27D4EB4Fu;
  }
};

struct Pair {
  Index from = 0;
  Index to = 0;
};

// Random distinct pairs of poses that are close in the city but not along the
// path, the earlier one first, in order of the later one.
std::vector<Pair> loop_pairs(const LatticePath& path, std::int64_t wanted, double radius,
                             Random& random) {
  std::unordered_map<Cell, std::vector<Index>, CellHash> visits;
  for (std::size_t k = 0; k < path.cells.size(); ++k) {
    visits[path.cells[k]].push_back(static_cast<Index>(k));
  }
  const auto reach = static_cast<std::int64_t>(radius);
  const auto partners = [&](Index pose) {
    std::vector<Index> close;
    for (std::int64_t dx = -reach; dx <= reach; ++dx) {
      for (std::int64_t dy = -reach; dy <= reach; ++dy) {
        if (std::hypot(static_cast<double>(dx), static_cast<double>(dy)) > radius) continue;
        const auto found = visits.find({path.cells[pose].x + dx, path.cells[pose].y + dy});
        if (found == visits.end()) continue;
        for (const Index other : found->second) {
          if (other + kLoopGap <= pose) close.push_back(other);
        }
      }
    }
    return close;
  };

  std::vector<Pair> pairs;
  std::unordered_set<std::uint64_t> taken;
  // Draws that hit a pose without partners, or a pair twice, are thrown away; the
  // bound stops the search where the path offers too few pairs.
  const std::int64_t most_draws = 50 * wanted + 1000;
  for (std::int64_t draw = 0; draw < most_draws && static_cast<std::int64_t>(pairs.size()) < wanted;
       ++draw) {
    const auto later = static_cast<Index>(random.index(path.cells.size()));
    const auto close = partners(later);
    if (close.empty()) continue;
    const Index earlier = close[random.index(close.size())];
    const std::uint64_t key =
        static_cast<std::uint64_t>(earlier) << 32 | static_cast<std::uint64_t>(later);
    if (taken.insert(key).second) pairs.push_back({earlier, later});
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return a.to != b.to ? a.to < b.to : a.from < b.from;
  });
  return pairs;
}

Pose2::Tangent unit_noise(Random& random) {
  const double x = random.normal();
  const double y = random.normal();
  return {x, y, random.normal()};
}

Constraint<Pose2> measure(const std::vector<Pose2>& truth, const Pair& pair,
                          const Pose2::Tangent& unit, const Pose2::Tangent& sigma) {
  Constraint<Pose2> constraint;
  constraint.from = pair.from;
  constraint.to = pair.to;
  constraint.T_from_to =
      truth[pair.from].inverse() * truth[pair.to] * Pose2::exp(sigma.cwiseProduct(unit));
  constraint.information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  return constraint;
}

double end_error(const std::vector<Pose2>& truth, const std::vector<Pose2::Tangent>& noise,
                 const Pose2::Tangent& sigma) {
  Pose2 end = truth.front();
  for (std::size_t k = 0; k < noise.size(); ++k) {
    end = end * measure(truth, {static_cast<Index>(k), static_cast<Index>(k + 1)}, noise[k], sigma)
                    .T_from_to;
  }
  return (end.translation() - truth.back().translation()).norm();
}

// The factor on the noise with which the end of the path is missed by `drift`.
// The error is continuous in the factor and zero at zero, so that growing the
// factor brackets a solution, which bisection then finds.
double scale_for_drift(const std::vector<Pose2>& truth, const std::vector<Pose2::Tangent>& noise,
                       const Pose2::Tangent& sigma, double drift) {
  double low = 0.0;
  double high = 1e-3;
  while (end_error(truth, noise, high * sigma) < drift) {
    low = high;
    high *= 1.25;
    if (high > 1e4) {
      throw InvalidArgument("drift", "this path cannot drift so far");
    }
  }
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (end_error(truth, noise, middle * sigma) < drift ? low : high) = middle;
  }
  return high;
}

}  // namespace

void CityOptions::validate() const {
  if (poses < 1 || poses > 100'000'000) throw InvalidArgument("poses", "must be in [1, 10^8]");
  if (loops < -1) throw InvalidArgument("loops", "must be -1 or more");
  if (block < 1) throw InvalidArgument("block", "must be at least 1");
  require_positive("odometry_sigma", odometry_sigma);
  require_positive("odometry_turn_sigma", odometry_turn_sigma);
  require_positive("loop_sigma", loop_sigma);
  require_positive("loop_turn_sigma", loop_turn_sigma);
  require_positive("loop_radius", loop_radius);
  if (!(std::isfinite(drift) && drift >= 0.0)) {
    throw InvalidArgument("drift", "must be finite and not negative");
  }
}

Simulation<Pose2> simulate_city(const CityOptions& options) {
  options.validate();
  Random random(options.seed);
  const auto path = drive(options, random);

  Simulation<Pose2> simulation;
  simulation.truth = exact_poses(path);
  auto& graph = simulation.graph;
  for (std::int64_t k = 0; k < options.poses; ++k) graph.ids.push_back(static_cast<VertexId>(k));

  std::vector<Pose2::Tangent> noise;
  for (std::int64_t k = 1; k < options.poses; ++k) noise.push_back(unit_noise(random));
  Pose2::Tangent sigma(options.odometry_sigma, options.odometry_sigma, options.odometry_turn_sigma);
  if (options.drift > 0.0) {
    sigma *= scale_for_drift(simulation.truth, noise, sigma, options.drift);
  }
  for (Index k = 0; k + 1 < static_cast<Index>(options.poses); ++k) {
    graph.constraints.push_back(measure(simulation.truth, {k, k + 1}, noise[k], sigma));
  }
  graph.poses = odometry_poses(graph, edge_roles(graph));

  const Pose2::Tangent loop_sigma(options.loop_sigma, options.loop_sigma, options.loop_turn_sigma);
  const std::int64_t loops = options.loops < 0 ? options.poses / 2 : options.loops;
  for (const auto& pair : loop_pairs(path, loops, options.loop_radius, random)) {
    graph.constraints.push_back(measure(simulation.truth, pair, unit_noise(random), loop_sigma));
  }
  return simulation;
}

}  // namespace isotherm::slam
