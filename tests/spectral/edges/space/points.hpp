#pragma once

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "spectral/graphs.hpp"

namespace isotherm_test {

/// Points in the unit ball, a column each.
inline Eigen::MatrixXd points_in_ball(Index count, Index dimension, Random& random) {
  Eigen::MatrixXd points(dimension, count);
  for (Index k = 0; k < count;) {
    for (Index c = 0; c < dimension; ++c) points(c, k) = random.uniform(-1.0, 1.0);
    if (points.col(k).norm() <= 1.0) ++k;
  }
  return points;
}

/// Points joined where they are nearer than `radius`; the last `false_count` edges join others.
inline WeightedGraph contacts(const Eigen::MatrixXd& points, double radius, Index false_count,
                              Random& random) {
  const auto count = static_cast<Index>(points.cols());
  std::vector<WeightedEdge> edges;
  std::set<std::pair<Index, Index>> known;
  for (Index i = 0; i < count; ++i) {
    for (Index j = i + 1; j < count; ++j) {
      if ((points.col(i) - points.col(j)).norm() >= radius) continue;
      known.emplace(i, j);
      edges.push_back({i, j, 1.0});
    }
  }
  while (false_count > 0) {
    const Index first = random_vertex(random, count), second = random_vertex(random, count);
    const auto [i, j] = std::minmax(first, second);
    if (i == j || !known.emplace(i, j).second) continue;
    edges.push_back({i, j, 1.0});
    --false_count;
  }
  return {count, std::move(edges)};
}

}  // namespace isotherm_test
