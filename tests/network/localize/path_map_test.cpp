#include "localize/start/path_map.hpp"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "isotherm/geometry/points/point_alignment.hpp"
#include "isotherm/network/simulate/simulate_network.hpp"
#include "network/localize/networks.hpp"
#include "network/localize/range_problems.hpp"

namespace isotherm::network::detail {
namespace {

/// Part of the nodes that are nearer than `tolerance` to the truth after the best isometry.
double share_near(const Placement& map, const Eigen::MatrixXd& truth, double tolerance) {
  std::vector<Index> nodes;
  for (Index v = 0; v < truth.cols(); ++v) {
    if (map.placed[v]) nodes.push_back(v);
  }
  const Eigen::MatrixXd found = map.positions(Eigen::all, nodes);
  const Eigen::MatrixXd wanted = truth(Eigen::all, nodes);
  const Eigen::VectorXd off =
      (geometry::align_points(found, wanted).apply(found) - wanted).colwise().norm().transpose();
  return static_cast<double>((off.array() < tolerance).count()) / static_cast<double>(truth.cols());
}

TEST(PathMap, IsTheNetworkUpToAnIsometry) {
  for (const int dimension : {2, 3}) {
    const auto simulated = simulate_network({.nodes = 250,
                                             .dimension = dimension,
                                             .anchors = 0,
                                             .degree = dimension == 2 ? 14.0 : 20.0,
                                             .noise = 0.02,
                                             .seed = 3});
    const auto problem = make_problem(simulated.network);
    const auto map = map_by_paths({problem, all_of(problem), kGate, {}}, Errors::any);
    EXPECT_GT(share_near(map, simulated.truth, 0.3 * simulated.radius), 0.9) << dimension;
  }
}

TEST(PathMap, StandsRangesThatAreTooLong) {
  const auto simulated = simulate_network({.nodes = 300,
                                           .anchors = 0,
                                           .degree = 14.0,
                                           .noise = 0.05,
                                           .biased_fraction = 0.2,
                                           .seed = 1});
  const auto problem = make_problem(simulated.network);
  const auto map = map_by_paths({problem, all_of(problem), kGate, {}}, Errors::too_long);
  EXPECT_GT(share_near(map, simulated.truth, 0.5 * simulated.radius), 0.9);
}

TEST(Unfold, DrawsATornMapTogether) {
  // A corner that has turned about the end of one of its sides, away from the rest.
  const auto simulated =
      simulate_network({.nodes = 900, .anchors = 0, .degree = 14.0, .noise = 0.02, .seed = 4});
  const auto problem = make_problem(simulated.network);
  const Eigen::Rotation2Dd turn(0.12);
  const Eigen::Vector2d hinge(0.6, 1.0);
  Placement map{simulated.truth, std::vector<bool>(900, true)};
  for (Index v = 0; v < 900; ++v) {
    const Eigen::Vector2d place = simulated.truth.col(v);
    if (place.minCoeff() > 0.6) map.positions.col(v) = turn * (place - hinge) + hinge;
  }
  const double near = 0.3 * simulated.radius;
  EXPECT_LT(share_near(map, simulated.truth, near), 0.9);
  unfold({problem, all_of(problem), kGate, {}}, Errors::any, map);
  EXPECT_GT(share_near(map, simulated.truth, near), 0.98);
}

TEST(PathMap, PlacesTheLargestPart) {
  const auto simulated = simulate_network({.nodes = 60, .anchors = 0, .degree = 20.0, .seed = 2});
  auto network = simulated.network;
  network.names.push_back("apart");
  network.names.push_back("too");
  network.positions.conservativeResize(2, 62);
  RangeMeasurement range;
  range.from = 60;
  range.to = 61;
  range.distance = 1.0;
  network.ranges.push_back(range);
  const auto problem = make_problem(network);
  const auto map = map_by_paths({problem, all_of(problem), kGate, {}}, Errors::any);
  EXPECT_FALSE(map.placed[60]);
  EXPECT_FALSE(map.placed[61]);
  EXPECT_GE(placed_count(map), 55);
}

TEST(PathMap, OfTooFewNodesIsEmpty) {
  const Eigen::MatrixXd points = Eigen::MatrixXd::Random(2, 2);
  const auto pair = make_problem(exact_network(points, all_pairs({0, 1})));
  EXPECT_EQ(placed_count(map_by_paths({pair, all_of(pair), kGate, {}}, Errors::any)), 0);
  const auto none = make_problem(exact_network(Eigen::MatrixXd(2, 0), {}));
  EXPECT_EQ(placed_count(map_by_paths({none, {}, kGate, {}}, Errors::any)), 0);
  // All in one place.
  const Eigen::MatrixXd heap = Eigen::MatrixXd::Zero(2, 6);
  const auto same = make_problem(exact_network(heap, all_pairs({0, 1, 2, 3, 4, 5})));
  EXPECT_TRUE(map_by_paths({same, all_of(same), kGate, {}}, Errors::any).positions.allFinite());
}

}  // namespace
}  // namespace isotherm::network::detail
