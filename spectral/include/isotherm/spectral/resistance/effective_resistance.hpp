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
  /// The same without the edges that join a pair directly: for an edge of a graph without
  /// parallel ones, the resistance without itself, +infinity for a bridge.
  std::vector<double> without;
  /// Bound on the relative error of each of these, whatever the weights. +infinity where none is
  /// known: for graphs too large for eliminations without subtraction, and weights over more than
  /// 200 decades.
  double bound = 0.0;
  /// Where there is no bound: largest deviation from 1 on the diagonal of (grounded L) * (its
  /// inverse), as a measure of rounding.
  double residual = 0.0;
  double seconds = 0.0;
};

/// The resistance of every edge, in order of edge id. Vertices are eliminated by star-mesh
/// transforms, without any subtraction, up and down the tree of an elimination order: about ten
/// times the cost of a factorisation, however many edges there are. Where that were more than 2e10
/// operations or 400 MB, one factorisation of the grounded Laplacian and selected inversion: about
/// three times the cost of the factorisation. Self-loops get 0.
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
/// 1e-9, where rounding drowns the difference, which ResistanceResult::without does not form.
double leave_one_out_resistance(double resistance, double weight);

}  // namespace isotherm::spectral
