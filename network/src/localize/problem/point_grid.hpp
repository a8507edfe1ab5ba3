#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "localize/problem/range_problem.hpp"

namespace isotherm::network::detail {

/// Numbered points of the plane or of space in square cells, to find those near a place.
/// Visits come in the order of cells, then of insertion. nanoflann's dynamic tree takes up to 3.8
/// times as long (docs/results/libraries.md).
class PointGrid {
 public:
  explicit PointGrid(double cell) : cell_(cell) {}

  void insert(std::int32_t number, const Point& point) {
    cells_[key(cell_of(point))].emplace_back(number, point);
  }

  /// Calls visit(number, point) for all points at most `radius` away, and perhaps some more.
  template <class Visit>
  void visit_near(const Point& place, double radius, const Visit& visit) const {
    const Cell low = cell_of(place, -radius);
    const Cell high = cell_of(place, radius);
    Cell at = low;
    for (at[0] = low[0]; at[0] <= high[0]; ++at[0]) {
      for (at[1] = low[1]; at[1] <= high[1]; ++at[1]) {
        for (at[2] = low[2]; at[2] <= high[2]; ++at[2]) {
          const auto found = cells_.find(key(at));
          if (found == cells_.end()) continue;
          for (const auto& [number, point] : found->second) visit(number, point);
        }
      }
    }
  }

 private:
  using Cell = std::array<std::int64_t, 3>;

  // Of the point moved by `shift` along every axis.
  Cell cell_of(const Point& point, double shift = 0.0) const {
    // Far enough for any map, near enough for a key.
    constexpr double kMost = 1e6;
    Cell cell = {0, 0, 0};
    for (Eigen::Index i = 0; i < point.size(); ++i) {
      const double number = std::floor((point[i] + shift) / cell_);
      cell[i] = static_cast<std::int64_t>(std::clamp(number, -kMost, kMost));
    }
    return cell;
  }

  static std::uint64_t key(const Cell& cell) {
    constexpr std::int64_t kOffset = 1 << 20;
    std::uint64_t result = 0;
    for (const auto c : cell) result = result << 21 | static_cast<std::uint64_t>(c + kOffset);
    return result;
  }

  double cell_;
  std::unordered_map<std::uint64_t, std::vector<std::pair<std::int32_t, Point>>> cells_;
};

/// Pairs of columns of `points` at most `radius` (> 0) from each other that are `wanted` (all if
/// that is empty), ascending; of each point with an even sample of the later ones where these are
/// many, since of a heap there would be too many.
std::vector<std::pair<std::int32_t, std::int32_t>> near_pairs(
    const Eigen::MatrixXd& points, double radius,
    const std::function<bool(std::int32_t, std::int32_t)>& wanted = {});

/// The same of placed nodes.
std::vector<std::pair<Index, Index>> near_nodes(
    const Placement& placement, double radius,
    const std::function<bool(Index, Index)>& wanted = {});

}  // namespace isotherm::network::detail
