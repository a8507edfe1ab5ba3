// Curves and point sets: descriptors, neighbour graphs, alignment.
// This is all of the layer isotherm::geometry. A whole program:
//
//     #include <isotherm/geometry.hpp>
//     #include <isotherm/spectral.hpp>
//
//     int main(int, char** argv) {
//       using namespace isotherm;
//       const auto cloud = geometry::read_points(argv[1]);  // x,y[,z ...] rows
//       const auto graph = geometry::nearest_neighbour_graph(cloud.points, 7);
//       const auto result = spectral::judge_edges(graph);  // a rolled-up sheet has short circuits
//       spectral::write_verdicts(argv[2], result.verdicts);
//     }
#pragma once

#include "isotherm/geometry/curves/curve_stretch.hpp"
#include "isotherm/geometry/curves/lap_line.hpp"
#include "isotherm/geometry/curves/polyline.hpp"
#include "isotherm/geometry/points/neighbour_graph.hpp"
#include "isotherm/geometry/points/point_alignment.hpp"
#include "isotherm/geometry/points/point_cloud.hpp"
