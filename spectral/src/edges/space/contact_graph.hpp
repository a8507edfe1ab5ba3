#pragma once

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "isotherm/spectral/graph/weighted_graph.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"

namespace isotherm::spectral::detail {

/// A place for each vertex, a column each.
template <int Dimension>
using Places = Eigen::Matrix<double, Dimension, Eigen::Dynamic>;

/// How likely an edge is where vertices have places. Two that are d apart are near with probability
///
///   rho(d) = (1 - 0.01) / (1 + exp((d - 1) / width)),
///
/// so that 1 is how far edges reach. What is near is joined, and what is joined is near or one of
/// the false edges, which join any two alike. Places are normal around 0, which keeps what no edge
/// holds from drifting away.
struct ContactModel {
  double width = 0.03;
  double astray = 1e-3;  ///< probability that a false edge joins two given vertices
  double spread = std::numeric_limits<double>::infinity();  ///< deviation of a coordinate

  /// From here on a pair without an edge says next to nothing, and counts as no more than there.
  double silent_from() const { return 1.0 + kWidths * width; }

  /// Up to here an edge of reach 1 says next to nothing, and counts as no more than there.
  double certain_up_to() const { return std::max(0.0, 1.0 - kWidths * width); }

 private:
  static constexpr double kWidths = 5.0;  // log odds, of which 1 in 150 is left
};

/// A graph whose edges are contacts, and the other pairs of its vertices none. A chain of k edges
/// that stands for one edge reaches k times as far, and its ends are no pair without contact.
class ContactGraph {
 public:
  /// @param lengths of how many edges in a row each edge is made
  ContactGraph(const WeightedGraph& graph, std::span<const double> lengths);

  Index vertex_count() const { return vertex_count_; }

  /// Pairs without an edge that are no farther from each other. O(n^2).
  template <int Dimension>
  std::vector<VertexPair> open_pairs(const Places<Dimension>& places, double distance) const;

  /// -log of the probability of all edges, of the pairs without one and of the places, but for a
  /// constant, and its gradient. O(m + q).
  /// @param close the q pairs without an edge that may be nearer than model.silent_from()
  template <int Dimension>
  double energy(const Places<Dimension>& places, const ContactModel& model,
                std::span<const VertexPair> close, Places<Dimension>& gradient) const;

 private:
  struct Edge {
    VertexPair ends;
    double reach;
  };

  Index vertex_count_;
  std::vector<Edge> edges_;
  std::vector<char> joined_;  // by from * n + to
};

/// rho(d) for a pair that reaches as far.
double chance_of_contact(double distance, double reach, const ContactModel& model);

/// The probability of what is seen of a pair that is near with this probability: an edge or none.
double chance_of_pair(bool joined, double near, const ContactModel& model);

}  // namespace isotherm::spectral::detail
