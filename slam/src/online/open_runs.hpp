#pragma once

#include <algorithm>
#include <unordered_map>
#include <utility>
#include <vector>

#include "isotherm/slam/graph/pose_graph.hpp"
#include "prune/consensus/runs/labels.hpp"

namespace isotherm::slam::detail {

/// Loops that no snapshot has accepted, in runs of those that predict each other: one alone may
/// prove nothing where odometry has drifted, all of them together do.
///
/// Each loop is true or false. A true one adds to the evidence what the map makes of it or, where
/// the loop before it in its run is true too, what that predicts, if it is more.
/// Their odds are summed over all states of the run, which is a tree, by messages along it
/// (Pearl, Probabilistic Reasoning in Intelligent Systems, 1988).
class OpenRuns {
 public:
  static constexpr Index kNone = -1;

  struct Member {
    Index edge = 0;
    double own = 0.0;          ///< log of how much likelier true than false, given the map
    Index before = kNone;      ///< edge of the loop before it in its run, which was added before
    double with_before = 0.0;  ///< the same given that loop
  };

  /// What follows what as often as `labels` have it.
  explicit OpenRuns(const LabelCounts& labels = {}) : labels_(labels) {}

  bool contains(Index edge) const { return positions_.contains(edge); }

  /// @throws InvalidArgument if it is there, or what it names before it is not
  void add(const Member& member);

  /// The log odds of all loops of a run, by the edge of any one; a run of one, or none, as well.
  std::vector<std::pair<Index, double>> log_odds(Index edge) const;

 private:
  struct Node {
    Member member;
    Index parent = kNone;  // its position
    Index run = 0;

    double with_parent() const { return std::max(member.own, member.with_before); }
  };

  LabelCounts labels_;
  std::vector<Node> nodes_;
  std::unordered_map<Index, Index> positions_;  // by edge
  std::vector<std::vector<Index>> runs_;        // positions, the one before always first
};

}  // namespace isotherm::slam::detail
