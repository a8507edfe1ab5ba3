#include "edges/space/classical_scaling.hpp"

#include <gtest/gtest.h>

#include "edges/odds/step_counter.hpp"
#include "spectral/edges/space/points.hpp"

namespace isotherm::spectral::detail {
namespace {

using namespace isotherm_test;

Eigen::MatrixXd distances_between(const Eigen::MatrixXd& places) {
  Eigen::MatrixXd distances(places.cols(), places.cols());
  for (Index i = 0; i < places.cols(); ++i) {
    for (Index j = 0; j < places.cols(); ++j) {
      distances(i, j) = (places.col(i) - places.col(j)).norm();
    }
  }
  return distances;
}

TEST(ClassicalScaling, FindsPointsFromTheirDistances) {
  Random random(3);
  for (const Index dimension : {2, 3}) {
    const auto distances = distances_between(points_in_ball(50, dimension, random));
    const auto found = distances_between(classical_scaling(distances, dimension));
    EXPECT_LT((found - distances).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST(ClassicalScaling, TakesDistancesOfNoSpace) {
  const auto complete = complete_graph(12);
  const auto trust = equal_worth(complete);
  EXPECT_TRUE(classical_scaling(steps_between(complete, trust, trust), 3).allFinite());
}

TEST(StepsBetween, AreThoseOfAStepCounter) {
  Random random(4);
  const auto graph = loopy_path(60, 15, random);
  const auto trust = equal_worth(graph);
  StepCounter counter(graph, trust);
  const auto steps = steps_between(graph, trust, trust);
  for (Index i = 0; i < 60; ++i) {
    for (Index j = 0; j < 60; ++j) ASSERT_EQ(steps(i, j), counter.count({i, j}, 100, -1));
  }
}

TEST(StepsBetween, CountChainsByTheirLengthAndPartsAsFar) {
  const WeightedGraph graph(4, {{0, 1, 1.0}, {1, 2, 1.0}, {2, 3, 1.0}});
  const auto steps = steps_between(graph, std::vector{1.0, 4.0, 1.0}, std::vector{1.0, 0.5, 0.0});
  EXPECT_EQ(steps(0, 2), 5.0);
  EXPECT_EQ(steps(0, 3), 6.0);
}

}  // namespace
}  // namespace isotherm::spectral::detail
