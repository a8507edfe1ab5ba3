#pragma once

#include <array>
#include <vector>

#include "prune/consensus/constants.hpp"
#include "prune/consensus/estimate/reduced_graph.hpp"
#include "prune/consensus/objective/span_class.hpp"
#include "prune/consensus/pairs/loop_pair.hpp"

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
/// with probability in proportion to f(h) of their relative pose h, so that the odds of true
/// against false are N(z; h, S) f(h) / (f(z) f_mean): f_mean is the mean of f over random pairs
/// of poses that span about as many vertices, on the map in question. On a map shrunk to a point
/// every pair is near, and no loop proves anything. Where h is near z, f(h) / f(z) is about 1; of a
/// loop that says that two poses are near which the map has far from each other, however much it
/// may err, little is left.
///
/// f is a kernel around the median, as wide as loops differ, by their stated errors, and by half a
/// step of odometry either way: however well places are told apart, the nearest pose to one is up
/// to that far away. It is normal where near pairs are counted; how much nearer h is than z, of
/// which one may lie far out, is told by Student's t.
template <class Pose>
class NearDensity {
 public:
  /// Draws the pairs; the same for every map. `graph` must have loops and outlive this object.
  explicit NearDensity(const ReducedGraph<Pose>& graph);

  /// log f_mean of each proposal class, over maps that are as likely: the graph's nodes are at
  /// their poses.
  std::array<double, kProposalClasses> log_mean(const std::vector<std::vector<Pose>>& maps) const;

  /// log of the mean of f over pairs with both ends within `window` vertices of one of these loops,
  /// by what it measures and odometry alone: on no map.
  double log_mean_around(const ReducedGraph<Pose>& graph, const std::vector<Index>& loops,
                         Index window) const;

  /// log f(h) - log f(z) of a loop that measured z and is left the residual log(z^-1 h) by the map
  /// with it; `forward`: from the earlier vertex to the later one. The tails of f(z) are those of
  /// `tail_dof` degrees of freedom: no lighter than those of the residual, or else what is measured
  /// wildly wrong were a sign that poses are near.
  double log_nearer(const Pose& z, const typename Pose::Tangent& residual, bool forward,
                    double tail_dof = kTailDof) const;

 private:
  using Tangent = typename Pose::Tangent;

  /// A vertex of the full graph, as odometry ties it to a node.
  struct Place {
    Index vertex = 0;
    Index node = 0;
    Pose T_node_vertex;
  };

  /// Of each class of pairs: the kernel over its peak, summed over those that are near, and how
  /// many there are.
  struct Count {
    std::array<double, kProposalClasses> near;
    std::array<double, kProposalClasses> pairs;
  };

  struct Places;

  void fit(const ReducedGraph<Pose>& graph);
  void find_places(const ReducedGraph<Pose>& graph);
  Tangent offset(const Pose& T) const;
  double log_at(const Pose& T, double tail_dof) const;
  std::size_t class_of(std::size_t from, std::size_t to) const;
  void count_pairs(std::size_t anchor, std::array<double, kProposalClasses>& pairs) const;
  void count_near(const Places& on, std::size_t first, std::size_t stride, Count& count) const;

  Pose center_inverse_;
  typename Pose::Translation center_;
  Tangent deviation_;  // of the kernel
  double log_peak_ = 0.0;
  std::vector<Place> places_;
  std::vector<Index> chain_;          // of each place
  std::vector<std::size_t> anchors_;  // places in random order
  double stride_ = 1.0;               // vertices from place to place
};

extern template class NearDensity<Pose2>;
extern template class NearDensity<Pose3>;

}  // namespace isotherm::slam::detail
