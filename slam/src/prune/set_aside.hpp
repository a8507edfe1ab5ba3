#pragma once

#include <cstdint>
#include <vector>

#include "isotherm/slam/prune/prune.hpp"

namespace isotherm::slam::detail {

/// What no method is asked about: edges from a vertex to itself, which say nothing about
/// where two poses lie, and those that say again what another one says, which would count
/// as evidence of their own.
class SetAside {
 public:
  /// Takes such edges out of `roles`.
  template <class Pose>
  SetAside(const PoseGraph<Pose>& graph, EdgeRoles& roles);

  /// Gives them their rows among those of the candidates, in order of the edges: a repeat
  /// has the verdict of what it repeats, an edge from a vertex to itself is ambiguous.
  void return_to(PruneResult& result) const;

 private:
  struct Row {
    spectral::EdgeVerdict verdict;
    std::int64_t original = -1;  // the candidate that a repeat repeats; -1: none
  };

  template <class Pose>
  void take_self_edges(const PoseGraph<Pose>& graph, EdgeRoles& roles);
  template <class Pose>
  void take_repeats(const PoseGraph<Pose>& graph, EdgeRoles& roles);
  void warn(PruneResult& result) const;
  static spectral::EdgeVerdict verdict_of(const Row& row, const spectral::EdgeVerdict* original);

  std::vector<Row> rows_;  // one a candidate that was taken, in order of the edges
  std::uint64_t self_edges_ = 0;
  std::uint64_t repeats_ = 0;  // of odometry, too
};

}  // namespace isotherm::slam::detail
