#include "edges/odds/step_counter.hpp"

#include <algorithm>

namespace isotherm::spectral::detail {

StepCounter::StepCounter(const WeightedGraph& graph, std::span<const double> trust)
    : graph_(graph), trust_(trust), marks_(graph.vertex_count(), 0) {}

int StepCounter::count(VertexPair pair, int most, Index without) {
  if (pair.from == pair.to) return 0;
  ++searches_;
  Side first{{pair.from}, 2 * searches_}, second{{pair.to}, 2 * searches_ + 1};
  marks_[pair.from] = first.mark;
  marks_[pair.to] = second.mark;
  for (int steps = 1; steps <= most; ++steps) {
    const bool swap = second.rim.size() < first.rim.size();
    Side& side = swap ? second : first;
    if (grow(side, swap ? first.mark : second.mark, without)) return steps;
    if (side.rim.empty()) break;
  }
  return most + 1;
}

bool StepCounter::grow(Side& side, std::int64_t other_mark, Index without) {
  next_.clear();
  for (const Index vertex : side.rim) {
    for (const auto& [other, edge] : graph_.neighbours(vertex)) {
      if (edge == without || trust_[edge] == 0.0) continue;
      if (marks_[other] == other_mark) return true;
      if (marks_[other] == side.mark) continue;
      marks_[other] = side.mark;
      next_.push_back(other);
    }
  }
  side.rim.swap(next_);
  return false;
}

}  // namespace isotherm::spectral::detail
