#pragma once

#include <span>
#include <vector>

#include "distributed/graph/graph_state.hpp"
#include "isotherm/spectral/graph/laplacian.hpp"

/// Matrices and vectors of a graph, by rows.
namespace isotherm::spectral::distributed::detail {

/// A Laplacian of either kind; the combinatorial one is the graph's own.
class LaplacianMatrix {
 public:
  LaplacianMatrix(const Graph::State& graph, LaplacianKind kind);

  Mat get() const noexcept { return own_ ? own_.get() : graph_.laplacian.get(); }
  /// A bound on the largest eigenvalue.
  double norm() const noexcept { return norm_; }
  const Graph::State& graph() const noexcept { return graph_; }
  LaplacianKind kind() const noexcept { return kind_; }

  /// The null vectors' entry of a local row, up to a factor for the component.
  double null_entry(std::size_t local) const;

 private:
  const Graph::State& graph_;
  LaplacianKind kind_;
  MatHandle own_;
  double norm_ = 0.0;
};

/// The root of each edge's weight times the difference of its ends: an edge of `graph.edges` a
/// row. Energies and flows are made from it without subtracting degrees.
MatHandle incidence(const Graph::State& graph);

/// The null space of a Laplacian: a vector a component, which no rank has more of than its rows.
class NullSpace {
 public:
  explicit NullSpace(const LaplacianMatrix& laplacian);

  /// Takes out of x what is in the null space.
  void remove(Vec x) const { add(x, -1.0, x); }

  /// y += factor * (the part of x that is in the null space)
  void add(Vec x, double factor, Vec y) const;

  /// Entry of the unit null vector of a local row's component.
  double entry(std::size_t local) const { return entries_[local]; }

 private:
  const Graph::State& graph_;
  std::vector<double> entries_;
};

/// A vector of the graph's rows.
VecHandle make_vector(const Graph::State& graph);

/// 64 random bits for every counter (S. Vigna's SplitMix64).
std::uint64_t mixed(std::uint64_t counter);

/// Numbers in [-1, 1) that depend on positions and the seed only, whatever the ranks.
void fill_at_random(const Graph::State& graph, std::uint64_t seed, Vec x);

/// The entries of this rank's block.
std::vector<double> in_block(const Graph::State& graph, std::span<const double> of_rows);

/// What the components are called over all ranks: of each one that this rank has a part of, its
/// number in order of smallest positions.
std::vector<std::int64_t> component_numbers(const Graph::State& graph);

}  // namespace isotherm::spectral::distributed::detail
