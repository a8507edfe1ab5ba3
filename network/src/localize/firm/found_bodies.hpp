#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "isotherm/network/range_network.hpp"

namespace isotherm::network::detail {

/// Sets of nodes that are rigid bodies, as they are found one after the other. What comes to share
/// enough nodes with one of them holds the whole body, so that nodes of a large one are not tested
/// again for each of the many places that it can be reached from.
class FoundBodies {
 public:
  using Nodes = std::vector<Index>;

  /// Of so many nodes, with no bodies.
  explicit FoundBodies(Index nodes) : bodies_of_(nodes) {}

  /// Whether each of these nodes is in a body.
  bool cover(const Nodes& members) const;

  /// Begins a new body, without nodes.
  void begin_body();

  /// Enters nodes that the new body has come to have, each of them once. Of the other bodies that
  /// the nodes in common are enough to fix, as `is_enough` tells, nothing is left but what they
  /// bring to the new one: the nodes that were not in `firm`, which they are then.
  Nodes join(const Nodes& fresh, std::vector<bool>& firm,
             const std::function<bool(const Nodes&)>& is_enough);

  /// Ends the new body, which has these nodes.
  void end_body(Nodes nodes);

  /// Those that have not become part of another one, in the order in which they were begun.
  std::vector<Nodes> take() &&;

 private:
  std::size_t whole_of(std::size_t body);
  bool note(std::size_t body, Index node);

  std::vector<Nodes> bodies_;                        // empty: part of another one
  std::vector<std::size_t> joined_to_;               // body -> the one it is part of, or itself
  std::vector<std::vector<std::size_t>> bodies_of_;  // node -> bodies
  std::vector<Nodes> shared_;                        // body -> nodes that the new one has, too
  std::size_t current_ = 0;                          // the new one
};

}  // namespace isotherm::network::detail
