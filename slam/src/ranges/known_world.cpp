#include "ranges/known_world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "graph/find_root.hpp"
#include "isotherm/base/error.hpp"
#include "isotherm/base/statistics.hpp"

namespace isotherm::slam::detail {
namespace {

// Of ranges without a stated deviation, by their median: what it is follows from the ranges.
constexpr double kGuessedSigma = 0.01;

void check_range(const network::RangeMeasurement& range, Index nodes) {
  const bool exist = range.from >= 0 && range.to >= 0 && range.from < nodes && range.to < nodes;
  if (!exist || range.from == range.to) {
    throw InvalidArgument("ranges", "must be between two different nodes that exist");
  }
  if (!(range.distance >= 0.0) || !std::isfinite(range.distance) || !(range.variance >= 0.0)) {
    throw InvalidArgument("ranges", "must be finite, with variances that are not negative");
  }
}

template <class Pose>
void check_graph(const RangeGraph<Pose>& graph, const std::vector<Index>& anchors) {
  for (const auto& range : graph.ranges) check_range(range, graph.node_count());
  for (const auto& step : graph.steps) {
    const bool exist = step.from >= 0 && step.to >= 0 && step.from < graph.node_count() &&
                       step.to < graph.node_count();
    if (!exist) throw InvalidArgument("steps", "must be between nodes that exist");
    if (!step.information.allFinite()) throw InvalidArgument("steps", "must be finite");
  }
  for (const Index anchor : anchors) {
    if (anchor < 0 || anchor >= graph.node_count()) {
      throw InvalidArgument("anchors", "must be nodes that exist");
    }
    if (!graph.is_point[anchor] || !graph.placed[anchor]) {
      throw InvalidArgument("anchors", graph.names[anchor] + " is no point with a position");
    }
  }
}

template <class Pose>
void add_world(RangeGraph<Pose>& graph) {
  const Index world = graph.node_count();
  graph.names.emplace_back();
  graph.positions.emplace_back();
  graph.placed.push_back(true);
  graph.is_point.push_back(false);
  graph.stamps.push_back(-std::numeric_limits<double>::infinity());
  for (const auto& prior : graph.priors) {
    graph.steps.push_back({world, prior.node, prior.T_world_node, prior.information});
  }
}

}  // namespace

template <class Pose>
bool KnownWorld<Pose>::anchored() const {
  return std::ranges::find(held, true) != held.end();
}

template <class Pose>
KnownWorld<Pose> know_world(const RangeGraph<Pose>& graph, const std::vector<Index>& anchors) {
  check_graph(graph, anchors);
  KnownWorld<Pose> world{graph, std::vector<bool>(graph.names.size(), false), {}};
  for (const Index anchor : anchors) world.held[anchor] = true;
  if (!graph.priors.empty()) {
    add_world(world.graph);
    world.held.push_back(true);
  }
  if (graph.ranges.empty()) return world;
  std::vector<double> distances;
  for (const auto& range : graph.ranges) distances.push_back(range.distance);
  world.longest = *std::ranges::max_element(distances);
  if (!(world.longest > 0.0)) throw InvalidArgument("ranges", "are all zero");
  const double guess = kGuessedSigma * std::max(median(distances), 1e-6 * world.longest);
  for (const auto& range : graph.ranges) {
    world.sigma.push_back(range.variance > 0.0 ? std::sqrt(range.variance) : guess);
  }
  world.typical_sigma = median(world.sigma);
  return world;
}

Index Bodies::of(Index node) { return find_root(parent, node); }

void Bodies::join(Index a, Index b) {
  a = of(a);
  b = of(b);
  parent[std::max(a, b)] = std::min(a, b);
}

namespace {

// Of each body, what is held, or else its first pose, or else its first point.
template <class Pose>
Gauge gauge_of(const KnownWorld<Pose>& world, Bodies& bodies) {
  const Index count = world.graph.node_count();
  std::vector<Index> fixed(static_cast<std::size_t>(count), -1);
  const auto holds = [&](Index v) {
    const auto rank = [&](Index u) { return world.held[u] ? 0 : world.graph.is_point[u] ? 2 : 1; };
    Index& now = fixed[bodies.of(v)];
    if (now < 0 || rank(v) < rank(now)) now = v;
  };
  Gauge gauge;
  for (Index v = 0; v < count; ++v) {
    if (bodies.active[v]) holds(v);
  }
  gauge.variable.assign(static_cast<std::size_t>(count), -1);
  for (Index v = 0; v < count; ++v) {
    if (!bodies.active[v] || world.held[v] || fixed[bodies.of(v)] == v) continue;
    gauge.variable[v] = gauge.variable_count++;
  }
  return gauge;
}

}  // namespace

template <class Pose>
RangeProblem<Pose> problem_of(const KnownWorld<Pose>& world, Bodies& bodies) {
  RangeProblem<Pose> problem;
  problem.is_point = world.graph.is_point;
  problem.gauge = gauge_of(world, bodies);
  problem.longest = world.longest;
  // Between what noise hides and the longest range.
  problem.typical_excess = network::typical_excess(world.typical_sigma, world.longest);
  for (const auto& step : world.graph.steps) {
    if (!bodies.active[step.from] || !bodies.active[step.to]) continue;
    problem.steps.constraints.push_back(step);
  }
  for (std::size_t k = 0; k < world.graph.ranges.size(); ++k) {
    const auto& range = world.graph.ranges[k];
    if (!bodies.active[range.from] || !bodies.active[range.to]) continue;
    if (bodies.of(range.from) != bodies.of(range.to)) continue;
    problem.terms.push_back(
        {range.from, range.to, range.distance, world.sigma[k], static_cast<Index>(k)});
  }
  return problem;
}

template struct KnownWorld<Pose2>;
template struct KnownWorld<Pose3>;
template KnownWorld<Pose2> know_world(const RangeGraph<Pose2>&, const std::vector<Index>&);
template KnownWorld<Pose3> know_world(const RangeGraph<Pose3>&, const std::vector<Index>&);
template RangeProblem<Pose2> problem_of(const KnownWorld<Pose2>&, Bodies&);
template RangeProblem<Pose3> problem_of(const KnownWorld<Pose3>&, Bodies&);

}  // namespace isotherm::slam::detail
