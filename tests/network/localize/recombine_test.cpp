#include "localize/fold/recombine.hpp"

#include <gtest/gtest.h>

#include "isotherm/network/simulate/simulate_network.hpp"
#include "localize/evidence/evidence.hpp"
#include "localize/refine/polish.hpp"
#include "network/localize/networks.hpp"
#include "network/localize/range_problems.hpp"

namespace isotherm::network::detail {
namespace {

/// A network with its true places, and nodes of it that are near each other.
struct Known {
  SimulatedNetwork simulated = simulate_network({.nodes = 300, .degree = 15.0, .seed = 3});
  RangeProblem problem = make_problem(simulated.network);
  std::vector<bool> trusted = all_of(problem);
  LocalizeOptions options = {};
  MapTask task{problem, trusted, kGate, options};
  Placement truth{simulated.truth, std::vector<bool>(problem.nodes, true)};

  std::vector<Index> near(const Eigen::Vector2d& place, double radii) const {
    std::vector<Index> nodes;
    for (Index v = 0; v < problem.nodes; ++v) {
      const double off = (simulated.truth.col(v) - place).norm();
      if (!problem.is_anchor[v] && off < radii * simulated.radius) nodes.push_back(v);
    }
    return nodes;
  }

  // The map with these nodes elsewhere.
  Placement shifted(const std::vector<Index>& nodes) const {
    auto map = truth;
    for (const Index v : nodes) map.positions.col(v).x() += 0.7 * simulated.radius;
    return map;
  }

  double off(const Placement& map, const std::vector<Index>& nodes) const {
    double largest = 0.0;
    for (const Index v : nodes) {
      largest = std::max(largest, (map.positions.col(v) - simulated.truth.col(v)).norm());
    }
    return largest / simulated.radius;
  }
};

TEST(DifferingParts, AreConnectedNodesThatAreElsewhere) {
  const Known known;
  const auto here = known.near({0.25, 0.25}, 1.0);
  const auto there = known.near({0.75, 0.75}, 1.0);
  auto both = here;
  both.insert(both.end(), there.begin(), there.end());
  const auto moves = differing_parts(known.task, known.truth, known.shifted(both));
  ASSERT_EQ(moves.size(), 2U);
  for (const auto& part : {here, there}) {
    const bool found = moves[0].part == part || moves[1].part == part;
    EXPECT_TRUE(found);
  }
  EXPECT_TRUE(differing_parts(known.task, known.truth, known.truth).empty());
}

TEST(Recombine, TakesFromEachMapWhatIsLikelierThere) {
  const Known known;
  const auto here = known.near({0.25, 0.25}, 1.0);
  const auto there = known.near({0.75, 0.75}, 1.0);
  auto map = known.shifted(here);
  EXPECT_TRUE(recombine(known.task, known.shifted(there), map));
  EXPECT_LT(known.off(map, here), 0.2);
  EXPECT_LT(known.off(map, there), 0.2);
  EXPECT_FALSE(recombine(known.task, known.shifted(there), map));
}

TEST(Polish, NeverMakesAMapWorse) {
  const Known known;
  for (const double radii : {0.5, 1.0, 2.0}) {
    auto map = known.shifted(known.near({0.5, 0.5}, radii));
    const double before = worth(known.task, map);
    polish(known.task, map);
    EXPECT_GE(worth(known.task, map), before);
  }
}

}  // namespace
}  // namespace isotherm::network::detail
