#pragma once

#include <vector>

#include "isotherm/base/run_context.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"

namespace isotherm::spectral {

/// Seven diffusion times of a graph, descending and evenly spaced in their logarithms (S. Datta
/// et al., section V-D): from 5 / lambda_2, where exp(-lambda t) has decayed for all but the null
/// eigenvectors, to 0.001, both included, in units of 1 / weight. lambda_2 is the smallest
/// eigenvalue that is not null; without one, or where it is above 5000, all start at 1.
/// One factorisation and some tens of solves. @throws NumericalError, Cancelled
std::vector<double> automatic_scales(const WeightedGraph& graph, const RunContext& run = {});

/// The same for a graph whose smallest eigenvalue that is not null is known; 0 if there is none.
std::vector<double> automatic_scales(double smallest_eigenvalue);

}  // namespace isotherm::spectral
