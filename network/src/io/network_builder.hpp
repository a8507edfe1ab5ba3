#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "isotherm/network/range_network.hpp"

namespace isotherm::network::detail {

/// Collects the nodes of a file by name and keeps the positions that are given.
class NetworkBuilder {
 public:
  Index node(std::string_view name) {
    const auto [entry, added] =
        indices_.try_emplace(std::string(name), static_cast<Index>(network_.names.size()));
    if (added) {
      network_.names.push_back(entry->first);
      positions_.push_back({kUnknown, kUnknown, kUnknown});
    }
    return entry->second;
  }

  /// False if the node already has a position.
  bool place(Index node, const std::array<double, 3>& position) {
    if (!std::isnan(positions_[node][0])) return false;
    positions_[node] = position;
    return true;
  }

  void add_landmark(Index node) {
    if (landmark_.size() < network_.names.size()) landmark_.resize(network_.names.size(), false);
    landmark_[node] = true;
  }

  void add_range(const RangeMeasurement& range) { network_.ranges.push_back(range); }

  bool has_ranges() const { return !network_.ranges.empty(); }
  std::size_t range_count() const { return network_.ranges.size(); }

  RangeNetwork finish(int dimension) {
    network_.dimension = dimension;
    network_.positions.resize(dimension, static_cast<Eigen::Index>(positions_.size()));
    for (std::size_t v = 0; v < positions_.size(); ++v) {
      for (int i = 0; i < dimension; ++i) network_.positions(i, v) = positions_[v][i];
    }
    for (std::size_t v = 0; v < landmark_.size(); ++v) {
      if (landmark_[v]) network_.landmarks.push_back(static_cast<Index>(v));
    }
    return std::move(network_);
  }

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  RangeNetwork network_;
  std::vector<std::array<double, 3>> positions_;
  std::vector<bool> landmark_;
  std::unordered_map<std::string, Index> indices_;
};

}  // namespace isotherm::network::detail
