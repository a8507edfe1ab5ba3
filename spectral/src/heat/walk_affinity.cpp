#include "heat/walk_affinity.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "isotherm/base/parallel.hpp"

namespace isotherm::spectral::detail {
namespace {

/// A sparse matrix with the graph's pattern, by rows; trust 0 leaves an edge out.
class NormalisedAdjacency {
 public:
  struct Entry {
    Index vertex = 0;
    double value = 0.0;
  };

  NormalisedAdjacency(const WeightedGraph& graph, std::span<const double> trust)
      : of_edge_(graph.edges().size(), 0.0), offsets_(graph.vertex_count() + 1, 0) {
    const auto edges = graph.edges();
    double largest = 0.0;  // sums of weights near it must not overflow
    for (const auto& edge : edges) largest = std::max(largest, edge.weight);
    std::vector<double> weights(edges.size(), 0.0);
    std::vector<double> degrees(graph.vertex_count(), 0.0);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      if (edges[e].from == edges[e].to) continue;
      weights[e] = edges[e].weight / largest * trust[e];
      degrees[edges[e].from] += weights[e];
      degrees[edges[e].to] += weights[e];
    }
    for (std::size_t e = 0; e < edges.size(); ++e) {
      if (weights[e] == 0.0) continue;
      of_edge_[e] = std::sqrt(weights[e] / degrees[edges[e].from]) *
                    std::sqrt(weights[e] / degrees[edges[e].to]);
    }
    for (Index vertex = 0; vertex < graph.vertex_count(); ++vertex) {
      for (const auto& [other, edge] : graph.neighbours(vertex)) {
        if (of_edge_[edge] > 0.0) entries_.push_back({other, of_edge_[edge]});
      }
      offsets_[vertex + 1] = entries_.size();
    }
  }

  std::span<const Entry> row(Index vertex) const {
    return {entries_.data() + offsets_[vertex], entries_.data() + offsets_[vertex + 1]};
  }
  double of_edge(std::size_t edge) const { return of_edge_[edge]; }
  Index vertex_count() const { return static_cast<Index>(offsets_.size()) - 1; }

 private:
  std::vector<double> of_edge_;
  std::vector<std::size_t> offsets_;
  std::vector<Entry> entries_;
};

/// A vector that knows where it is not zero.
struct SparseColumn {
  std::vector<double> values;
  std::vector<Index> support;

  explicit SparseColumn(Index size) : values(size, 0.0) {}

  void add(Index vertex, double value) {
    if (values[vertex] == 0.0) support.push_back(vertex);
    values[vertex] += value;
  }
  void clear() {
    for (const Index vertex : support) values[vertex] = 0.0;
    support.clear();
  }
};

/// Entries of one column of the powers S^1 ... S^K, found one power after the other.
class ColumnWalk {
 public:
  explicit ColumnWalk(const NormalisedAdjacency& matrix)
      : matrix_(&matrix), current_(matrix.vertex_count()), next_(matrix.vertex_count()) {}

  /// Calls read(k, entry) for k = 1 ... horizon, where entry(v) is (S^k)_{v, start}.
  template <class Read>
  void run(Index start, int horizon, Read read) {
    current_.add(start, 1.0);
    for (int k = 1; k < horizon; ++k) {
      step();
      read(k, [this](Index vertex) { return current_.values[vertex]; });
    }
    // The last power is asked for in a few places only.
    read(horizon, [this](Index vertex) {
      double sum = 0.0;
      for (const auto& entry : matrix_->row(vertex)) {
        sum += entry.value * current_.values[entry.vertex];
      }
      return sum;
    });
    current_.clear();
  }

 private:
  void step() {
    for (const Index vertex : current_.support) {
      const double value = current_.values[vertex];
      for (const auto& entry : matrix_->row(vertex)) next_.add(entry.vertex, value * entry.value);
    }
    current_.clear();
    std::swap(current_, next_);
  }

  const NormalisedAdjacency* matrix_;
  SparseColumn current_, next_;
};

/// Which entries of each column are asked for: those of edges, then those of pairs.
struct Targets {
  struct Target {
    Index vertex = 0;
    std::size_t slot = 0;
  };
  std::vector<std::vector<Target>> of;  // by column

  Targets(const WeightedGraph& graph, std::span<const VertexPair> pairs)
      : of(graph.vertex_count()) {
    std::size_t slot = 0;
    for (const auto& edge : graph.edges()) of[edge.from].push_back({edge.to, slot++});
    for (const auto& pair : pairs) of[pair.from].push_back({pair.to, slot++});
  }
};

/// The 2 x 2 block of S^k that belongs to a pair.
struct Block {
  double first = 0.0;   // (i, i)
  double cross = 0.0;   // (i, j)
  double second = 0.0;  // (j, j)
};

/// Takes an entry c at (i, j) out of S, given the blocks of its powers (from S^0 on):
///   B_k = A_k - c sum_{l < k} A_{k-1-l} X B_l,   X = [0 1; 1 0],
/// which follows from S_e^k = S^k - sum_l S^{k-1-l} (S - S_e) S_e^l.
void leave_out(std::vector<Block>& blocks, double c) {
  // Walks that all use the edge cancel up to rounding.
  constexpr double kRounding = 1e-13;
  std::vector<Block> without = {blocks[0]};
  for (std::size_t k = 1; k < blocks.size(); ++k) {
    Block sum;
    for (std::size_t l = 0; l < k; ++l) {
      const Block& a = blocks[k - 1 - l];
      const Block& b = without[l];
      sum.first += a.first * b.cross + a.cross * b.first;
      sum.cross += a.first * b.second + a.cross * b.cross;
      sum.second += a.cross * b.second + a.second * b.cross;
    }
    Block left{blocks[k].first - c * sum.first, blocks[k].cross - c * sum.cross,
               blocks[k].second - c * sum.second};
    if (left.cross <= kRounding * blocks[k].cross) left.cross = 0.0;
    left.first = std::max(left.first, 0.0);
    left.second = std::max(left.second, 0.0);
    without.push_back(left);
  }
  blocks = std::move(without);
}

double affinity(const std::vector<Block>& blocks, double scale) {
  Block heat;
  double weight = 1.0;  // t^k / k!
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    if (k > 0) weight *= scale / static_cast<double>(k);
    heat.first += weight * blocks[k].first;
    heat.cross += weight * blocks[k].cross;
    heat.second += weight * blocks[k].second;
  }
  return std::clamp(heat.cross / std::sqrt(heat.first * heat.second), 0.0, 1.0);
}

}  // namespace

WalkAffinities walk_affinities(const WeightedGraph& graph, std::span<const double> trust,
                               std::span<const VertexPair> pairs,
                               const WalkAffinityOptions& options) {
  const NormalisedAdjacency matrix(graph, trust);
  const Targets targets(graph, pairs);
  const auto horizon = static_cast<std::size_t>(options.horizon);
  const std::size_t edge_count = graph.edges().size();
  std::vector<double> diagonal(static_cast<std::size_t>(graph.vertex_count()) * horizon);
  std::vector<double> cross((edge_count + pairs.size()) * horizon);
  parallel_for(
      graph.vertex_count(), 64, options.threads, options.progress, "heat walks",
      [&] { return ColumnWalk(matrix); },
      [&](ColumnWalk& walk, std::int64_t vertex) {
        const auto start = static_cast<Index>(vertex);
        walk.run(start, options.horizon, [&](int k, auto entry) {
          const auto level = static_cast<std::size_t>(k - 1);
          diagonal[start * horizon + level] = entry(start);
          for (const auto& [target, slot] : targets.of[start]) {
            cross[slot * horizon + level] = entry(target);
          }
        });
      });

  WalkAffinities result;
  result.edges.resize(edge_count);
  result.pairs.resize(pairs.size());
  const auto affinity_of = [&](std::vector<Block>& blocks, VertexPair pair, std::size_t slot,
                               double excluded) {
    if (pair.from == pair.to) return 1.0;
    blocks.assign(1, {1.0, 0.0, 1.0});
    for (std::size_t level = 0; level < horizon; ++level) {
      blocks.push_back({diagonal[pair.from * horizon + level], cross[slot * horizon + level],
                        diagonal[pair.to * horizon + level]});
    }
    if (excluded > 0.0) leave_out(blocks, excluded);
    return affinity(blocks, options.scale);
  };
  parallel_for(
      static_cast<std::int64_t>(edge_count + pairs.size()), 1024, options.threads, {}, "",
      [] { return std::vector<Block>(); },
      [&](std::vector<Block>& blocks, std::int64_t index) {
        const auto slot = static_cast<std::size_t>(index);
        if (slot < edge_count) {
          const auto& edge = graph.edges()[slot];
          result.edges[slot] =
              affinity_of(blocks, {edge.from, edge.to}, slot, matrix.of_edge(slot));
        } else {
          result.pairs[slot - edge_count] =
              affinity_of(blocks, pairs[slot - edge_count], slot, 0.0);
        }
      });
  return result;
}

int affordable_horizon(const WeightedGraph& graph, std::span<const double> trust, int wanted,
                       double budget) {
  constexpr Index kSample = 64;
  const Index count = graph.vertex_count();
  if (count == 0) return wanted;
  const Index stride = std::max<Index>(1, count / kSample);
  const double share = budget / count * std::min(count, kSample);
  std::vector<double> spent(wanted, 0.0);  // steps for a horizon of k + 1
  std::vector<Index> seen_by(count, -1);
  std::vector<Index> ball;
  for (Index start = 0; start < count; start += stride) {
    ball.assign(1, start);
    seen_by[start] = start;
    std::size_t inner = 0;  // vertices whose neighbours are in the ball already
    double steps = 0.0;
    for (int k = 1; k < wanted; ++k) {
      const std::size_t rim = ball.size();
      for (; inner < rim; ++inner) {
        for (const auto& [other, edge] : graph.neighbours(ball[inner])) {
          if (trust[edge] == 0.0) continue;
          steps += 1.0;
          if (seen_by[other] == start) continue;
          seen_by[other] = start;
          ball.push_back(other);
        }
      }
      spent[k] += steps;
      if (spent[k] > share) break;
    }
  }
  // A power reaches the whole ball again.
  double total = 0.0;
  int horizon = 2;
  for (int k = 1; k < wanted; ++k) {
    total += spent[k];
    if (total > share) break;
    horizon = k + 1;
  }
  return horizon;
}

}  // namespace isotherm::spectral::detail
