#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "isotherm/spectral/graph/weighted_graph.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"

/// The normalised heat affinity h_ij / sqrt(h_ii h_jj) of H(t) = exp(-tL): the
/// cosine between the heat embeddings at t / 2, in [0, 1], and unlike h_ij
/// itself not dominated by how well a vertex holds its own heat.
namespace isotherm::spectral {

/// Affinities, row-major: pairs x scales.
struct HeatAffinityResult {
  std::vector<double> scales;
  std::vector<CertifiedValue> values;  ///< pairs x scales
  double widest = 0.0;                 ///< largest width of a bracket
  std::int64_t imprecise = 0;          ///< values not known to a millionth of themselves
  double seconds = 0.0;

  const CertifiedValue& at(std::size_t pair, std::size_t scale) const {
    return values[pair * scales.size() + scale];
  }
  /// The values (bracket midpoints) of all pairs at one scale.
  std::vector<double> column(std::size_t scale) const;
};

/// The affinity of each pair at each scale. 1 for a pair (i, i), 0 between
/// components.
///
/// The tolerance of the options is that of the three heat kernel entries, all
/// found by the engine of HeatDistance; where both h_ii and h_jj are small the
/// brackets of their quotient are wider.
/// @throws InvalidArgument for a vertex outside the graph or a bad scale;
///   Cancelled.
HeatAffinityResult heat_affinities(const WeightedGraph& graph, std::span<const VertexPair> pairs,
                                   std::span<const double> scales,
                                   const HeatDistanceOptions& options = {});

/// The affinity of the ends of each edge (by id) in the graph without that edge
/// alone: what the rest of the graph says about it. Parallel edges stay.
/// 1 for a self-loop, 0 for a bridge.
/// @throws InvalidArgument for an id outside the graph or a bad scale; Cancelled.
HeatAffinityResult leave_one_out_affinities(const WeightedGraph& graph,
                                            std::span<const Index> edges,
                                            std::span<const double> scales,
                                            const HeatDistanceOptions& options = {});

}  // namespace isotherm::spectral
