// Weighted graphs: Laplacians, heat kernels, resistances, and the edges that do not belong.
// This is all of the layer isotherm::spectral. A whole program:
//
//     #include <isotherm/spectral.hpp>
//
//     int main(int, char** argv) {
//       using namespace isotherm::spectral;
//       const auto file = read_graph(argv[1]);        // from,to[,weight] rows, or MatrixMarket
//       const auto result = judge_edges(file.graph);  // by what the others say of each edge
//       const auto kept = apply_verdicts(file.graph, result.verdicts);
//       write_edge_csv(argv[2], kept, file.ids);
//     }
#pragma once

#include "isotherm/spectral/edges/edge_verdicts.hpp"
#include "isotherm/spectral/edges/judge_edges.hpp"
#include "isotherm/spectral/edges/multiscale_heat.hpp"
#include "isotherm/spectral/edges/threshold.hpp"
#include "isotherm/spectral/edges/verdict_file.hpp"
#include "isotherm/spectral/eigen/eigen_decomposition.hpp"
#include "isotherm/spectral/eigen/embed.hpp"
#include "isotherm/spectral/eigen/embedding.hpp"
#include "isotherm/spectral/eigen/vector_bounds.hpp"
#include "isotherm/spectral/graph/graph_file.hpp"
#include "isotherm/spectral/graph/laplacian.hpp"
#include "isotherm/spectral/graph/weighted_graph.hpp"
#include "isotherm/spectral/heat/heat_affinity.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"
#include "isotherm/spectral/heat/heat_kernel.hpp"
#include "isotherm/spectral/heat/heat_scales.hpp"
#include "isotherm/spectral/resistance/effective_resistance.hpp"
#include "isotherm/spectral/sparse/block_cholesky.hpp"
#include "isotherm/spectral/sparse/block_covariance.hpp"
#include "isotherm/spectral/sparse/branch_covariance.hpp"
#include "isotherm/spectral/sparse/damped_step.hpp"
#include "isotherm/spectral/sparse/earlier_factor.hpp"
#include "isotherm/spectral/sparse/laplacian_solver.hpp"
#include "isotherm/spectral/types.hpp"
