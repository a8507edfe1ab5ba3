#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "distributed/support/comm.hpp"

namespace isotherm::spectral::distributed::detail {

struct RowEdge;

/// Connected components over all ranks.
struct Components {
  std::int64_t count = 0;      ///< of the graph
  std::vector<Index> of_row;   ///< of this rank's rows, numbered on this rank
  std::vector<Index> label;    ///< of each of these: its smallest position
  std::vector<Index> slot;     ///< place among those that several ranks have a part of, or -1
  std::size_t slot_count = 0;  ///< the same on every rank
  std::vector<bool> first;     ///< whether this rank has the vertex that is the label

  std::size_t local_count() const { return label.size(); }

  /// For every component that this rank has a part of the sum over all of its rows, from the
  /// sums over this rank's. Collective.
  void add_up(const Comm& comm, std::span<double> sums) const;

  /// The same for the largest.
  void take_largest(const Comm& comm, std::span<double> values) const;
};

/// What is connected within a rank is found there; the smallest position then spreads from rank
/// to rank, in as many rounds as a component changes between ranks on its way.
Components find_components(const Comm& comm, const Blocks& rows, std::span<const RowEdge> edges,
                           std::span<const Index> position_of);

}  // namespace isotherm::spectral::distributed::detail
