#pragma once

#include <cstdint>
#include <vector>

#include "isotherm/spectral/types.hpp"

namespace isotherm::slam::detail {

using spectral::Index;

/// An undirected graph as one row of bits a vertex.
class BitGraph {
 public:
  explicit BitGraph(Index vertices)
      : vertices_(vertices),
        words_((static_cast<std::size_t>(vertices) + 63) / 64),
        bits_(static_cast<std::size_t>(vertices) * words_, 0) {}

  Index vertex_count() const noexcept { return vertices_; }
  void connect(Index a, Index b) {
    set(a, b);
    set(b, a);
  }
  bool connected(Index a, Index b) const {
    return (bits_[row(a) + word(b)] >> (static_cast<unsigned>(b) % 64) & 1u) != 0;
  }
  Index degree(Index vertex) const;

 private:
  std::size_t row(Index vertex) const { return static_cast<std::size_t>(vertex) * words_; }
  static std::size_t word(Index vertex) { return static_cast<std::size_t>(vertex) / 64; }
  void set(Index a, Index b) {
    bits_[row(a) + word(b)] |= std::uint64_t{1} << (static_cast<unsigned>(b) % 64);
  }

  Index vertices_;
  std::size_t words_;
  std::vector<std::uint64_t> bits_;
};

struct Clique {
  std::vector<Index> members;  ///< ascending
  bool proven = false;         ///< no larger one exists
};

/// A largest clique: greedy from every vertex, then branch and bound with greedy
/// colouring (E. Tomita, T. Seki, 2003). The search stops after `budget` branches
/// and then gives the best seen; counting branches instead of seconds keeps the
/// result the same on every machine.
Clique max_clique(const BitGraph& graph, std::int64_t budget);

}  // namespace isotherm::slam::detail
