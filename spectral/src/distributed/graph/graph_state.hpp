#pragma once

#include <cstdint>
#include <vector>

#include "distributed/graph/components.hpp"
#include "distributed/support/session.hpp"

namespace isotherm::spectral::distributed {

namespace detail {

/// An edge where its first end is. Ends are rows.
struct RowEdge {
  Index from = 0;
  Index to = 0;
  double weight = 0.0;
  std::int64_t place = 0;  ///< in the file
};

}  // namespace detail

/// Vertices have two numbers: the position, by the file's numbers in ascending order, of which
/// each rank has a block to answer for; and the row of vectors and matrices, by which each rank
/// has the part of the graph that the partitioner gave it.
struct Graph::State {
  const Session* session = nullptr;
  ReadReport report;

  detail::Blocks blocks;               // of positions
  std::vector<std::uint64_t> ids;      // of this rank's block
  std::vector<Index> row_of;           // of this rank's block
  detail::Blocks rows;                 // of rows
  std::vector<Index> position_of;      // of this rank's rows
  detail::Blocks places;               // of edges in the file: what each rank read
  std::vector<detail::RowEdge> edges;  // whose first end is a row of this rank, in order of place
  std::int64_t edge_count = 0;
  double cut = 0.0;

  detail::MatHandle laplacian;
  std::vector<double> degrees;  // of this rank's rows
  double norm_bound = 0.0;
  detail::Components components;

  const detail::Comm& comm() const { return session->state().comm; }
  Index first_row() const { return static_cast<Index>(rows.begin(comm().rank)); }
  std::size_t row_count() const { return position_of.size(); }
  bool owns(Index row) const { return row >= first_row() && row < rows.end(comm().rank); }
};

}  // namespace isotherm::spectral::distributed
