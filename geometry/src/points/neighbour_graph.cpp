#include "isotherm/geometry/points/neighbour_graph.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <nanoflann.hpp>

#include "isotherm/base/error.hpp"
#include "isotherm/base/parallel.hpp"

namespace isotherm::geometry {
namespace {

using spectral::Index;
using spectral::WeightedEdge;
using spectral::WeightedGraph;

// Squares of larger differences, summed up, may be infinite.
constexpr double kLargest = 1e150;

/// What nanoflann asks of a set of points.
struct Columns {
  const Eigen::MatrixXd& points;

  std::size_t kdtree_get_point_count() const { return static_cast<std::size_t>(points.cols()); }
  double kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return points(static_cast<Eigen::Index>(axis), static_cast<Eigen::Index>(index));
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Columns>,
                                                 Columns, -1, Index>;

void check_points(const Eigen::MatrixXd& points) {
  if (!(points.array().abs() <= kLargest).all()) {
    throw InvalidArgument("points", "coordinates must be finite and at most 1e150 in size");
  }
  if (points.cols() > std::numeric_limits<Index>::max()) {
    throw InvalidArgument("points", "more points than an Index counts");
  }
}

/// The graph of the pairs that `find(tree, point)` gives, in either order, a list a
/// point.
template <class Find>
WeightedGraph join(const Eigen::MatrixXd& points, const RunContext& run, const Find& find) {
  if (run.threads < 0) throw InvalidArgument("threads", "must not be negative");
  check_points(points);
  const auto count = static_cast<Index>(points.cols());
  if (count == 0 || points.rows() == 0) return {count, {}};
  const Columns columns{points};
  const Tree tree(static_cast<int>(points.rows()), columns);
  std::vector<std::vector<Index>> found(count);
  parallel_for(count, run.threads, run.progress, "neighbours",
               [&](std::int64_t point) { found[point] = find(tree, static_cast<Index>(point)); });
  std::vector<std::pair<Index, Index>> pairs;
  for (Index point = 0; point < count; ++point) {
    for (const Index other : found[point]) pairs.push_back(std::minmax(point, other));
    found[point] = {};
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  if (pairs.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max() / 2)) {
    throw InvalidArgument("radius", "gives more edges than an Index counts");
  }
  std::vector<WeightedEdge> edges;
  edges.reserve(pairs.size());
  for (const auto& [from, to] : pairs) edges.push_back({from, to, 1.0});
  return {count, std::move(edges)};
}

}  // namespace

WeightedGraph nearest_neighbour_graph(const Eigen::MatrixXd& points, int neighbours,
                                      const RunContext& run) {
  if (neighbours < 1) throw InvalidArgument("neighbours", "must be at least 1");
  // The point itself is found too, and ties at the last place are to be broken by
  // number, not by where they stand in the tree.
  constexpr Eigen::Index kTies = 16;
  const Eigen::Index wanted = std::min<Eigen::Index>(neighbours, points.cols() - 1);
  const Eigen::Index asked = std::min(wanted + 1 + kTies, points.cols());
  return join(points, run, [&](const Tree& tree, Index point) {
    std::vector<Index> indices(asked);
    std::vector<double> squares(asked);
    tree.knnSearch(points.col(point).data(), static_cast<std::size_t>(asked), indices.data(),
                   squares.data());
    std::vector<std::pair<double, Index>> near;
    for (Eigen::Index k = 0; k < asked; ++k) {
      if (indices[k] != point) near.emplace_back(squares[k], indices[k]);
    }
    std::sort(near.begin(), near.end());
    std::vector<Index> nearest;
    for (Eigen::Index k = 0; k < wanted; ++k) nearest.push_back(near[k].second);
    return nearest;
  });
}

WeightedGraph radius_graph(const Eigen::MatrixXd& points, double radius, const RunContext& run) {
  if (!(std::isfinite(radius) && radius > 0.0)) {
    throw InvalidArgument("radius", "must be finite and positive");
  }
  return join(points, run, [&](const Tree& tree, Index point) {
    std::vector<std::pair<Index, double>> matches;
    // The search leaves out points at exactly its radius.
    const double square = std::nextafter(radius * radius, std::numeric_limits<double>::infinity());
    tree.radiusSearch(points.col(point).data(), square, matches, nanoflann::SearchParams());
    std::vector<Index> near;
    for (const auto& match : matches) {
      if (match.first > point) near.push_back(match.first);
    }
    return near;
  });
}

}  // namespace isotherm::geometry
