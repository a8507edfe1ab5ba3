// Whatever the order in which edges come, however often and from whichever end they are told, the
// final verdicts are the same.
#include <cstddef>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "isotherm/slam/prune/prune.hpp"
#include "slam/online/online_graphs.hpp"

namespace isotherm::slam {
namespace {

using spectral::Verdict;

template <class Pose>
class OnlineInterleavingOf : public testing::Test {};
using PlanarAndSpatial = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(OnlineInterleavingOf, PlanarAndSpatial);

// An edge as it is told, and its place in the graph.
template <class Pose>
struct Told {
  Constraint<Pose> edge;
  std::size_t original = 0;
};

// In any order, one in four reversed and one in four told twice.
template <class Pose>
std::vector<Told<Pose>> any_interleaving(const PoseGraph<Pose>& graph, Random& random) {
  std::vector<Told<Pose>> told;
  for (std::size_t k = 0; k < graph.constraints.size(); ++k) {
    told.push_back({graph.constraints[k], k});
    auto& edge = told.back().edge;
    if (random.index(4) == 0) {
      const auto carry = edge.T_from_to.adjoint();
      edge.information = carry.inverse().transpose() * edge.information * carry.inverse();
      edge.information = (0.5 * (edge.information + edge.information.transpose())).eval();
      edge.T_from_to = edge.T_from_to.inverse();
      std::swap(edge.from, edge.to);
    }
    if (random.index(4) == 0) told.push_back(told.back());
  }
  for (std::size_t k = told.size(); k > 1; --k) std::swap(told[k - 1], told[random.index(k)]);
  return told;
}

// ISOTHERM_INTERLEAVED_GRAPHS=50 makes a thousand interleavings with both kinds of poses.
std::uint64_t graph_count() {
  const char* wanted = std::getenv("ISOTHERM_INTERLEAVED_GRAPHS");
  return wanted != nullptr ? std::stoull(wanted) : 5;
}

TYPED_TEST(OnlineInterleavingOf, EndsTheSame) {
  using Pose = TypeParam;
  constexpr int kInterleavings = 10;  // of each graph
  for (std::uint64_t seed = 1; seed <= graph_count(); ++seed) {
    const auto graph = isotherm_test::corrupted_graph<Pose>(seed, 16, 8);
    std::map<std::size_t, Verdict> expected;
    for (const auto& row : prune(graph).verdicts) {
      expected[static_cast<std::size_t>(row.edge)] = row.verdict;
    }
    Random random(seed);
    for (int trial = 0; trial < kInterleavings; ++trial) {
      const auto told = any_interleaving(graph, random);
      OnlineConsensus<Pose> online;
      for (const auto& [edge, original] : told) isotherm_test::add(online, graph, edge);
      online.finish();
      std::map<std::size_t, Verdict> found;
      for (const auto& row : online.verdicts()) {
        const auto original = told[static_cast<std::size_t>(row.edge)].original;
        const auto [at, first] = found.emplace(original, row.verdict);
        EXPECT_EQ(at->second, row.verdict) << "two answers to one loop";
      }
      for (const auto& [edge, verdict] : expected) EXPECT_EQ(found.at(edge), verdict) << seed;
    }
  }
}

}  // namespace
}  // namespace isotherm::slam
