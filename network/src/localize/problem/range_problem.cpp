#include "localize/problem/range_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "isotherm/base/error.hpp"
#include "localize/constants.hpp"

namespace isotherm::network::detail {
namespace {

void merge_pairs(RangeProblem& problem) {
  auto groups = group_by_pair(problem.ranges);
  std::vector<spectral::WeightedEdge> edges;
  for (const auto& group : groups.ranges) {
    const auto& first = problem.ranges[group.front()];
    const double distance =
        median_over(group, [&](std::size_t k) { return problem.ranges[k].distance; });
    const double sigma = median_over(group, [&](std::size_t k) { return problem.sigmas[k]; });
    problem.pairs.push_back({first.from, first.to, distance, sigma});
    edges.push_back({first.from, first.to, 1.0});
  }
  problem.pair_of = std::move(groups.pair_of);
  problem.pair_graph = spectral::WeightedGraph(problem.nodes, std::move(edges));
}

}  // namespace

PairGroups group_by_pair(const std::vector<RangeMeasurement>& ranges) {
  PairGroups groups;
  std::map<std::pair<Index, Index>, Index> number_of;
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    const auto [entry, added] = number_of.try_emplace(std::minmax(ranges[k].from, ranges[k].to),
                                                      static_cast<Index>(groups.ranges.size()));
    if (added) groups.ranges.emplace_back();
    groups.pair_of.push_back(entry->second);
    groups.ranges[entry->second].push_back(k);
  }
  return groups;
}

double median_over(const std::vector<std::size_t>& numbers,
                   const std::function<double(std::size_t)>& value_of) {
  std::vector<double> values;
  for (const std::size_t k : numbers) values.push_back(value_of(k));
  return lower_median(std::move(values));
}

void check(const RangeNetwork& network) {
  const auto fail = [](std::size_t k, const std::string& problem) {
    throw InvalidArgument("ranges[" + std::to_string(k) + "]", problem);
  };
  if (network.dimension != 2 && network.dimension != 3) {
    throw InvalidArgument("dimension", "must be 2 or 3");
  }
  if (network.positions.size() > 0 && (network.positions.rows() != network.dimension ||
                                       network.positions.cols() != network.node_count())) {
    throw InvalidArgument("positions", "must be dimension x nodes");
  }
  const auto unknown = [&](Index v) { return v < 0 || v >= network.node_count(); };
  for (std::size_t k = 0; k < network.ranges.size(); ++k) {
    const auto& range = network.ranges[k];
    if (unknown(range.from) || unknown(range.to)) fail(k, "joins a node that does not exist");
    if (range.from == range.to) fail(k, "joins " + network.names[range.from] + " to itself");
    if (!std::isfinite(range.distance) || range.distance < 0.0) {
      fail(k, "distance must be finite and >= 0");
    }
    if (!std::isfinite(range.variance) || range.variance < 0.0) {
      fail(k, "variance must be finite and >= 0");
    }
  }
  for (const Index v : network.landmarks) {
    if (unknown(v)) throw InvalidArgument("landmarks", "name a node that does not exist");
  }
}

bool RangeProblem::anchored() const {
  return std::find(is_anchor.begin(), is_anchor.end(), true) != is_anchor.end();
}

double lower_median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + (static_cast<std::ptrdiff_t>(values.size()) - 1) / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Placement place_nodes(const RangeProblem& problem, const std::vector<Index>& nodes,
                      const Eigen::MatrixXd& positions) {
  Placement placement;
  placement.positions.setZero(problem.dimension, problem.nodes);
  placement.placed.assign(problem.nodes, false);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    placement.placed[nodes[k]] = true;
    placement.positions.col(nodes[k]) = positions.col(static_cast<Eigen::Index>(k));
  }
  return placement;
}

Index placed_count(const Placement& placement) {
  return static_cast<Index>(std::count(placement.placed.begin(), placement.placed.end(), true));
}

double extent(const Placement& placement) {
  Eigen::AlignedBoxXd box(placement.positions.rows());
  for (Eigen::Index v = 0; v < placement.positions.cols(); ++v) {
    if (placement.placed[v]) box.extend(placement.positions.col(v));
  }
  return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

double deviation(const Placement& placement, const RangePair& pair) {
  return (distance_of(placement, pair.from, pair.to) - pair.distance) / pair.sigma;
}

double squared_deviation(const Placement& placement, const RangePair& pair) {
  return std::pow(deviation(placement, pair), 2);
}

std::vector<bool> within_steps(const RangeProblem& problem, const std::vector<Index>& nodes,
                               int steps, const std::vector<bool>& usable) {
  std::vector<bool> result(problem.nodes, false);
  for (const Index v : nodes) result[v] = true;
  auto rim = nodes;
  for (int step = 0; step < steps; ++step) {
    std::vector<Index> next;
    for (const Index v : rim) {
      for (const auto& [vertex, edge] : problem.pair_graph.neighbours(v)) {
        if (result[vertex] || (!usable.empty() && !usable[edge])) continue;
        result[vertex] = true;
        next.push_back(vertex);
      }
    }
    rim = std::move(next);
  }
  return result;
}

bool has_range(const RangeProblem& problem, Index a, Index b) {
  const auto row = problem.pair_graph.neighbours(a);
  return std::any_of(row.begin(), row.end(), [b](const auto& entry) { return entry.vertex == b; });
}

RangeProblem make_problem(const RangeNetwork& network) {
  RangeProblem problem;
  problem.dimension = network.dimension;
  problem.nodes = network.node_count();
  problem.ranges = network.ranges;
  problem.is_anchor.assign(network.names.size(), false);
  for (const Index v : network.landmarks) {
    if (network.positions.size() > 0 && network.positions.col(v).allFinite()) {
      problem.is_anchor[v] = true;
    }
  }
  std::vector<double> distances;
  for (const auto& range : problem.ranges) distances.push_back(range.distance);
  problem.typical_distance = distances.empty() ? 0.0 : lower_median(distances);
  const double floor = std::max(problem.typical_distance, 1e-300);
  for (const auto& range : problem.ranges) {
    problem.sigma_given.push_back(range.variance > 0.0);
    problem.sigmas.push_back(range.variance > 0.0 ? std::sqrt(range.variance)
                                                  : kProvisionalNoise * floor);
  }
  problem.typical_sigma = lower_median(problem.sigmas);
  merge_pairs(problem);
  return problem;
}

Placement anchors_only(const RangeNetwork& network, const RangeProblem& problem) {
  Placement placement;
  placement.positions.setZero(problem.dimension, problem.nodes);
  placement.placed = problem.is_anchor;
  for (Index v = 0; v < problem.nodes; ++v) {
    if (problem.is_anchor[v]) placement.positions.col(v) = network.positions.col(v);
  }
  return placement;
}

bool span_space(const RangeProblem& problem, const Placement& placement,
                const std::vector<Index>& nodes) {
  constexpr double kFlat = 1e-9;  // of the nodes' extent: a line up to rounding
  if (static_cast<int>(nodes.size()) <= problem.dimension) return false;
  const Eigen::MatrixXd points = placement.positions(Eigen::all, nodes);
  const Eigen::MatrixXd centred = points.colwise() - points.rowwise().mean();
  const Eigen::VectorXd values = centred.jacobiSvd().singularValues();
  const double noise = problem.sigmas.empty() ? 0.0 : kHardlyNoise * problem.typical_sigma;
  return values.minCoeff() > std::max(noise, kFlat * values.maxCoeff());
}

bool anchors_span_space(const RangeProblem& problem, const Placement& placement) {
  std::vector<Index> anchors;
  for (Index v = 0; v < problem.nodes; ++v) {
    if (problem.is_anchor[v] && placement.placed[v]) anchors.push_back(v);
  }
  return span_space(problem, placement, anchors);
}

}  // namespace isotherm::network::detail
