#include "localize/problem/point_grid.hpp"

namespace isotherm::network::detail {

std::vector<std::pair<std::int32_t, std::int32_t>> near_pairs(
    const Eigen::MatrixXd& points, double radius,
    const std::function<bool(std::int32_t, std::int32_t)>& wanted) {
  constexpr std::size_t kMost = 300;  // several times what a network has
  const auto n = static_cast<std::int32_t>(points.cols());
  PointGrid grid(radius);
  for (std::int32_t v = 0; v < n; ++v) grid.insert(v, points.col(v));
  std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
  std::vector<std::int32_t> found;
  for (std::int32_t v = 0; v < n; ++v) {
    found.clear();
    const Point place = points.col(v);
    grid.visit_near(place, radius, [&](std::int32_t other, const Point& position) {
      if (other <= v || !(distance_between(position, place) <= radius)) return;
      if (!wanted || wanted(v, other)) found.push_back(other);
    });
    std::sort(found.begin(), found.end());
    const std::size_t stride = found.empty() ? 1 : (found.size() - 1) / kMost + 1;
    for (std::size_t k = 0; k < found.size(); k += stride) pairs.emplace_back(v, found[k]);
  }
  return pairs;
}

std::vector<std::pair<Index, Index>> near_nodes(const Placement& placement, double radius,
                                                const std::function<bool(Index, Index)>& wanted) {
  std::vector<Index> nodes;
  for (std::size_t v = 0; v < placement.placed.size(); ++v) {
    if (placement.placed[v]) nodes.push_back(static_cast<Index>(v));
  }
  auto pairs = near_pairs(
      placement.positions(Eigen::all, nodes), radius,
      [&](std::int32_t a, std::int32_t b) { return !wanted || wanted(nodes[a], nodes[b]); });
  for (auto& [a, b] : pairs) {
    a = nodes[a];
    b = nodes[b];
  }
  return pairs;
}

}  // namespace isotherm::network::detail
