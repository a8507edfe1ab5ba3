// Sensor networks: find the nodes from ranges, and the ranges that are false.
// This is all of the layer isotherm::network. A whole program:
//
//     #include <isotherm/network.hpp>
//
//     int main(int, char** argv) {
//       using namespace isotherm::network;
//       auto network = read_ranges(argv[1]).network;    // CSV, PyFG and others
//       set_anchors(network, read_positions(argv[2]));  // the nodes whose place is known
//       const auto result = localize(network);          // places, and a verdict on every range
//       write_positions(argv[3], network, result);
//     }
#pragma once

#include "isotherm/network/io/position_file.hpp"
#include "isotherm/network/io/range_file.hpp"
#include "isotherm/network/io/range_rows.hpp"
#include "isotherm/network/localize/anchor_conflicts.hpp"
#include "isotherm/network/localize/localize.hpp"
#include "isotherm/network/localize/range_mixture.hpp"
#include "isotherm/network/range_network.hpp"
#include "isotherm/network/simulate/simulate_network.hpp"
#include "isotherm/spectral/edges/verdict_file.hpp"
