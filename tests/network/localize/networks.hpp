#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "isotherm/network/range_network.hpp"

namespace isotherm::network {

/// Nodes at `truth` with exact ranges between the given pairs.
inline RangeNetwork exact_network(const Eigen::MatrixXd& truth,
                                  const std::vector<std::pair<int, int>>& pairs,
                                  const std::vector<Index>& anchors = {}) {
  RangeNetwork network;
  network.dimension = static_cast<int>(truth.rows());
  for (Eigen::Index v = 0; v < truth.cols(); ++v) network.names.push_back(std::to_string(v));
  network.positions.setConstant(truth.rows(), truth.cols(),
                                std::numeric_limits<double>::quiet_NaN());
  network.landmarks = anchors;
  for (const Index v : anchors) network.positions.col(v) = truth.col(v);
  for (const auto& [a, b] : pairs) {
    RangeMeasurement range;
    range.from = a;
    range.to = b;
    range.distance = (truth.col(a) - truth.col(b)).norm();
    network.ranges.push_back(range);
  }
  return network;
}

inline std::vector<std::pair<int, int>> all_pairs(const std::vector<int>& nodes) {
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    for (std::size_t b = a + 1; b < nodes.size(); ++b) pairs.emplace_back(nodes[a], nodes[b]);
  }
  return pairs;
}

}  // namespace isotherm::network
