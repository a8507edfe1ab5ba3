#pragma once

#include <array>
#include <vector>

#include "prune/consensus/estimate/reduced_graph.hpp"
#include "prune/consensus/objective/span_class.hpp"

namespace isotherm::slam::detail {

/// Loops that span about as many vertices, and those between different chains.
inline constexpr std::size_t kProposalClasses = kSpanClasses + 1;

template <class Pose>
std::size_t proposal_class(const ReducedGraph<Pose>& graph, Index loop) {
  return graph.same_chain(graph.loops[loop]) ? span_class(graph.span(loop)) : kSpanClasses;
}

/// How easily two poses are near each other on a map by chance.
///
/// A front end proposes pairs of poses that look near. A false loop joins any pair and measures
/// z with the density f of what loops measure; a true one joins a pair that is near on the map,
/// with probability in proportion to a kernel k of their relative pose h, so that the odds of
/// true against false are N(z; h, S) k(h) / (f(z) k_mean): k_mean is the mean of k over random
/// pairs of poses that span about as many vertices, on the map in question. On a map shrunk to
/// a point every pair is near, and no loop proves anything. Since h is near z, k(z) stands for
/// k(h).
template <class Pose>
class NearDensity {
 public:
  /// Draws the pairs; the same for every map. `graph` must have loops and outlive this object.
  explicit NearDensity(const ReducedGraph<Pose>& graph);

  /// log k_mean of each proposal class, with the graph's nodes at `poses`.
  std::array<double, kProposalClasses> log_mean(const std::vector<Pose>& poses) const;

  using Tangent = typename Pose::Tangent;

  /// log f(z) / k(z) of a loop's measurement z, from the earlier to the later pose.
  double log_false_density(const Pose& measured) const;

 private:
  /// A vertex of the full graph, as odometry ties it to a node.
  struct Place {
    Index vertex = 0;
    Index node = 0;
    Pose T_node_vertex;
  };

  void fit(const ReducedGraph<Pose>& graph);
  void find_places(const ReducedGraph<Pose>& graph);
  Tangent offset(const Pose& T) const;
  std::size_t class_of(std::size_t from, std::size_t to) const;
  void count_pairs(std::size_t anchor, std::array<double, kProposalClasses>& pairs) const;

  Pose center_inverse_;
  typename Pose::Translation center_;
  Tangent inverse_deviation_;
  Tangent narrower_;  // of k: times the deviation of what loops measure
  std::vector<Place> places_;
  std::vector<Index> chain_;          // of each place
  std::vector<std::size_t> anchors_;  // places in random order
  double stride_ = 1.0;               // vertices from place to place
  double reach_ = 0.0;                // beyond it k is nothing
};

extern template class NearDensity<Pose2>;
extern template class NearDensity<Pose3>;

}  // namespace isotherm::slam::detail
