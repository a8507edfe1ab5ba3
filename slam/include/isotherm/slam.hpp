// Pose graphs: prune their false loop closures, find their poses, compare with the truth.
// This is all of the layer isotherm::slam. A whole program:
//
//     #include <isotherm/slam.hpp>
//
//     int main(int, char** argv) {
//       using namespace isotherm::slam;
//       const auto file = read_pose_graph(argv[1]);       // g2o or TORO, plane or space
//       const auto map = prune_and_optimize(file);        // decides on every loop, finds the poses
//       write_g2o(argv[2], map.pruned);                   // without the false loops
//       write_verdicts(argv[3], map.decisions.verdicts);  // why, a row a loop
//     }
#pragma once

#include "isotherm/slam/evaluate/evaluate_loops.hpp"
#include "isotherm/slam/evaluate/evaluate_online.hpp"
#include "isotherm/slam/evaluate/ground_truth.hpp"
#include "isotherm/slam/evaluate/labels.hpp"
#include "isotherm/slam/evaluate/trajectory_metrics.hpp"
#include "isotherm/slam/graph/any_pose_graph.hpp"
#include "isotherm/slam/graph/diagnose.hpp"
#include "isotherm/slam/graph/graph_summary.hpp"
#include "isotherm/slam/graph/information.hpp"
#include "isotherm/slam/graph/odometry.hpp"
#include "isotherm/slam/graph/pose.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"
#include "isotherm/slam/graph/range_graph.hpp"
#include "isotherm/slam/graph/repeats.hpp"
#include "isotherm/slam/graph/replay_order.hpp"
#include "isotherm/slam/graph/trajectory.hpp"
#include "isotherm/slam/graph/trusted_edges.hpp"
#include "isotherm/slam/graph/usable_odometry.hpp"
#include "isotherm/slam/io/candidate_list.hpp"
#include "isotherm/slam/io/file_format.hpp"
#include "isotherm/slam/io/pose_graph_file.hpp"
#include "isotherm/slam/io/pose_graph_stream.hpp"
#include "isotherm/slam/io/trajectory_file.hpp"
#include "isotherm/slam/online/online_consensus.hpp"
#include "isotherm/slam/optimize/initialize.hpp"
#include "isotherm/slam/optimize/optimize.hpp"
#include "isotherm/slam/optimize/robust_kernel.hpp"
#include "isotherm/slam/pipeline.hpp"
#include "isotherm/slam/prune/chi2_prune.hpp"
#include "isotherm/slam/prune/consensus.hpp"
#include "isotherm/slam/prune/curve_evidence.hpp"
#include "isotherm/slam/prune/curve_prune.hpp"
#include "isotherm/slam/prune/heat_prune.hpp"
#include "isotherm/slam/prune/induce.hpp"
#include "isotherm/slam/prune/kernel_prune.hpp"
#include "isotherm/slam/prune/loop_evidence.hpp"
#include "isotherm/slam/prune/odometry_chi2.hpp"
#include "isotherm/slam/prune/pcm.hpp"
#include "isotherm/slam/prune/prune.hpp"
#include "isotherm/slam/prune/rrr.hpp"
#include "isotherm/slam/ranges/locate.hpp"
#include "isotherm/slam/ranges/range_graph_file.hpp"
#include "isotherm/slam/ranges/range_robots.hpp"
#include "isotherm/slam/simulate/corrupt.hpp"
#include "isotherm/slam/simulate/densify.hpp"
#include "isotherm/slam/simulate/simulate.hpp"
#include "isotherm/spectral/edges/verdict_file.hpp"
