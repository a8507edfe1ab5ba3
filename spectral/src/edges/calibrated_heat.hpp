#pragma once

#include <span>

#include "isotherm/base/run_context.hpp"
#include "isotherm/spectral/edges/multiscale_heat.hpp"

namespace isotherm::spectral::detail {

/// Algorithm 1 where something else has told how likely each candidate is a true edge: the
/// threshold of each scale is where distances are as often those of false edges as of true ones
/// (calibrate()), instead of eq. 11.
/// @param truth one a candidate
MultiscaleHeat calibrated_heat(const WeightedGraph& graph, std::span<const Index> candidates,
                               std::span<const double> truth, const MultiscaleHeatOptions& options,
                               const RunContext& run);

}  // namespace isotherm::spectral::detail
