#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "isotherm/spectral/graph/weighted_graph.hpp"
#include "isotherm/spectral/types.hpp"

/// Effective resistances R_ij = (e_i - e_j)' L^+ (e_i - e_j), edge weights
/// being conductances; the integral of D_ij(t) over all t.
namespace isotherm::spectral {

/// Effective resistances of a list of pairs.
struct ResistanceResult {
  std::vector<double> values;  ///< per pair; +infinity between components, 0 for (i, i)
  /// Largest deviation from 1 on the diagonal of (grounded L) * (its inverse),
  /// as a measure of rounding; not a bound.
  double residual = 0.0;
  double seconds = 0.0;
};

/// The resistance of every edge, in order of edge id, by one factorisation of
/// the grounded Laplacian and selected inversion: about three times the cost of
/// the factorisation, however many edges there are. Self-loops get 0.
/// @throws NumericalError if the factorisation breaks down.
ResistanceResult edge_resistances(const WeightedGraph& graph);

/// The resistances of any pairs. Those that are not edges enter the pattern of
/// the factorisation, which for many far-away pairs costs fill.
/// @throws InvalidArgument for a vertex outside the graph; NumericalError.
ResistanceResult effective_resistances(const WeightedGraph& graph,
                                       std::span<const VertexPair> pairs);

/// Commute times: resistance times the volume (sum of weighted degrees) of the
/// component; +infinity between components.
///
/// On large graphs with dense neighbourhoods they tend to 1/d_i + 1/d_j and
/// say nothing about distance (von Luxburg, Radl and Hein 2014).
/// @throws InvalidArgument for a vertex outside the graph; NumericalError.
ResistanceResult commute_times(const WeightedGraph& graph, std::span<const VertexPair> pairs);

/// R / (1 - w R): the resistance between an edge's ends without the edge, from
/// its resistance R and its weight w. +infinity for a bridge: 1 - w R below
/// 1e-9, where rounding drowns the difference.
double leave_one_out_resistance(double resistance, double weight);

}  // namespace isotherm::spectral
