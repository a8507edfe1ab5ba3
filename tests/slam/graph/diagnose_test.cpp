#include "isotherm/slam/graph/diagnose.hpp"

#include <numbers>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/slam/simulate/corrupt.hpp"
#include "isotherm/slam/simulate/simulate.hpp"

namespace isotherm::slam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Simulation<Pose2> simulated() {
  return simulate_city({.poses = 600, .measurements = {.loops = 120}, .seed = 5});
}

PoseGraph<Pose2> city() { return simulated().graph; }

template <class Pose>
std::vector<std::string> kinds(const PoseGraph<Pose>& graph) {
  std::vector<std::string> found;
  for (const auto& doubt : diagnose(graph, edge_roles(graph))) found.push_back(doubt.kind);
  return found;
}

template <class Change>
PoseGraph<Pose2> city_with(const Change& change) {
  auto graph = city();
  for (const bool odometry : {true, false}) {
    const auto roles = edge_roles(graph);
    for (const Index k : odometry ? roles.odometry : roles.candidates) {
      change(graph.constraints[k], odometry);
    }
  }
  return graph;
}

void invert(Constraint<Pose2>& edge) { edge.T_from_to = edge.T_from_to.inverse(); }

TEST(Diagnose, HasNothingToSayOfASoundGraph) {
  EXPECT_THAT(kinds(city()), IsEmpty());
  EXPECT_THAT(kinds(PoseGraph<Pose3>()), IsEmpty());
  EXPECT_THAT(kinds(simulate_sphere({.seed = 2}).graph), IsEmpty());
}

TEST(Diagnose, FalseLoopsAreNotSwappedOnes) {
  const auto [graph, truth] = simulated();
  EXPECT_THAT(kinds(corrupt(graph, truth, {.fraction = 0.95, .seed = 1}).graph), IsEmpty());
}

TEST(Diagnose, SwappedEnds) {
  for (const auto& which : {std::pair(true, false), {false, true}, {true, true}}) {
    const auto graph = city_with([&](auto& edge, bool odometry) {
      if (odometry ? which.first : which.second) invert(edge);
    });
    const auto doubts = diagnose(graph, edge_roles(graph));
    ASSERT_EQ(doubts.size(), 1u);
    EXPECT_EQ(doubts[0].kind, "swapped ends");
    EXPECT_THAT(doubts[0].message, HasSubstr(which.first && which.second ? "of all edges"
                                             : which.first               ? "of odometry"
                                                                         : "of loops"));
  }
}

TEST(Diagnose, AnglesInDegrees) {
  const auto graph = city_with([](auto& edge, bool) {
    edge.T_from_to = {edge.T_from_to.translation(),
                      wrap_angle(edge.T_from_to.angle() * 180.0 / std::numbers::pi)};
  });
  const auto found = kinds(graph);
  // A turn of a quarter is beyond half a turn, taken as radians, and lost when it is wrapped.
  EXPECT_THAT(found, testing::AnyOf(IsEmpty(), ElementsAre("angles in degrees")));
  auto gentle = simulate_ring({.seed = 1}).graph;
  for (auto& edge : gentle.constraints) {
    edge.T_from_to = {edge.T_from_to.translation(),
                      edge.T_from_to.angle() * 180.0 / std::numbers::pi};
  }
  EXPECT_THAT(kinds(gentle), ElementsAre("angles in degrees"));
}

TEST(Diagnose, OdometryThatIsMissingOrUnderOtherNumbers) {
  auto graph = city();
  const auto roles = edge_roles(graph);
  std::vector<bool> keep(graph.constraints.size(), true);
  for (const Index k : roles.odometry) keep[k] = false;
  EXPECT_THAT(kinds(filter_constraints(graph, keep)), testing::Contains("no odometry"));
  keep.assign(keep.size(), true);
  keep[roles.odometry[100]] = false;
  const auto broken = filter_constraints(graph, keep);
  const auto doubts = diagnose(broken, edge_roles(broken));
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_EQ(doubts[0].kind, "broken odometry");
  EXPECT_THAT(doubts[0].message, HasSubstr("no edge joins 1 of 599 pairs"));
  auto bridged = broken;
  bridged.constraints.push_back(graph.constraints[roles.odometry[100]]);
  ++bridged.constraints.back().to;
  EXPECT_THAT(kinds(bridged), ElementsAre("bridged odometry"));
  bridged.robots.resize(bridged.ids.size());
  for (Index v : {100, 102}) bridged.robots[v] = 1;  // no neighbours are apart
  EXPECT_THAT(kinds(bridged), testing::Not(testing::Contains("bridged odometry")));
  // 7 and 600 have no factor in common: every pose gets a number, far from the last one's.
  for (auto& edge : graph.constraints) {
    edge.from = edge.from * 7 % 600;
    edge.to = edge.to * 7 % 600;
  }
  EXPECT_THAT(kinds(graph), ElementsAre("ids without order"));
}

TEST(Diagnose, InformationThatSaysNothing) {
  auto graph = city();
  const auto with = [&](const Pose2::Matrix& information) {
    for (auto& edge : graph.constraints) edge.information = information;
    return kinds(graph);
  };
  EXPECT_THAT(with(Pose2::Matrix::Zero()), ElementsAre("zero information"));
  EXPECT_THAT(with(Pose2::Matrix::Identity()), ElementsAre("identity information"));
  EXPECT_THAT(with(4.0 * Pose2::Matrix::Identity()), ElementsAre("identical information"));
  EXPECT_THAT(diagnose(graph, edge_roles(graph)).front().message,
              HasSubstr("deviations of 0.5 m and 0.5 rad"));
}

}  // namespace
}  // namespace isotherm::slam
