#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::spectral::detail {

/// Counts the fewest steps between vertices, searching from both ends. One a thread.
class StepCounter {
 public:
  /// Edges whose `trust` is 0 are left out. Both arguments must outlive this object.
  StepCounter(const WeightedGraph& graph, std::span<const double> trust);

  /// At most `most`; `most` + 1 if it takes more. The edge `without` is left out; none is if < 0.
  /// Time: the edges within `most` / 2 steps of both ends.
  int count(VertexPair pair, int most, Index without);

 private:
  struct Side {
    std::vector<Index> rim;
    std::int64_t mark = 0;
  };

  /// One step further; true if that meets the other side.
  bool grow(Side& side, std::int64_t other_mark, Index without);

  const WeightedGraph& graph_;
  std::span<const double> trust_;
  std::vector<std::int64_t> marks_;  // of the side that reached each vertex last
  std::int64_t searches_ = 0;
  std::vector<Index> next_;
};

}  // namespace isotherm::spectral::detail
