#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

#include "isotherm/base/range.hpp"
#include "isotherm/network/range_network.hpp"

namespace isotherm::network {

/// Sensors at random in the unit square or cube, with noisy ranges between those
/// that are near each other, some of them false or biased.
struct NetworkOptions {
  std::int64_t nodes = 1000;  ///< anchors included; >= 2
  int dimension = 2;          ///< 2 or 3
  std::int64_t anchors = 10;  ///< nodes whose position is known, in [0, nodes]
  /// Number of neighbours of a node away from the border, > 0; sets the radius
  /// within which ranges are measured.
  double degree = 12.0;
  double radius = 0.0;           ///< sides; > 0 overrides `degree`, 0 leaves it
  double noise = 0.05;           ///< standard deviation as a part of the distance, in [0, 0.3]
  double false_fraction = 0.0;   ///< of all ranges, between nodes anywhere; in [0, 0.9]
  double biased_fraction = 0.0;  ///< of all ranges, too long for want of sight; in [0, 0.9]
  std::uint64_t seed = 0;

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, NetworkOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("nodes", options.nodes, "number of nodes, anchors included", closed(2, 1e7));
  visit("dimension", options.dimension, "2 (unit square) or 3 (unit cube)", closed(2, 3));
  visit("anchors", options.anchors, "number of nodes with a known position", closed(0, 1e7));
  visit("degree", options.degree, "neighbours of a node away from the border", left_open(0, 1e6));
  visit("radius", options.radius, "longest distance measured; 0: from the degree", closed(0, 2));
  visit("noise", options.noise, "standard deviation of a range, as a part of the distance",
        closed(0, 0.3));
  visit("false_fraction", options.false_fraction, "part of the ranges that join any two nodes",
        closed(0, 0.9));
  visit("biased_fraction", options.biased_fraction, "part of the ranges that are too long",
        closed(0, 0.9));
}

/// What a simulated range is.
enum class RangeOrigin {
  measured,  ///< noise only
  biased,    ///< between neighbours, too long by a quarter to one radius
  invented,  ///< between nodes out of range of each other, with any length within the radius
};

/// A network with the truth it was made from.
struct SimulatedNetwork {
  RangeNetwork network;              ///< positions of the anchors only, which are its landmarks
  Eigen::MatrixXd truth;             ///< dimension x nodes
  std::vector<RangeOrigin> origins;  ///< one a range
  double radius = 0.0;
};

/// Deterministic in the options. Nodes are called 0, 1, ...; the anchors come
/// first. A range states the standard deviation it was drawn with; that of an
/// invented one is `noise` times its length. Ranges are in random order and
/// direction. O(nodes * degree).
/// @throws InvalidArgument for options out of range
SimulatedNetwork simulate_network(const NetworkOptions& options);

}  // namespace isotherm::network
