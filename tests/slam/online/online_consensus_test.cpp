#include "isotherm/slam/online/online_consensus.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/base/random.hpp"
#include "isotherm/slam/graph/odometry.hpp"
#include "isotherm/slam/optimize/optimize.hpp"
#include "isotherm/slam/prune/prune.hpp"
#include "slam/online/online_graphs.hpp"

namespace isotherm::slam {
namespace {

using isotherm_test::add;
using isotherm_test::add_all;
using isotherm_test::corrupted_graph;
using isotherm_test::random_loop_graph;
using spectral::Verdict;

template <class Pose>
class OnlineConsensusOf : public testing::Test {};
using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(OnlineConsensusOf, Poses);

void expect_same(const spectral::EdgeVerdicts& a, const spectral::EdgeVerdicts& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].edge, b[k].edge);
    EXPECT_EQ(a[k].verdict, b[k].verdict) << a[k].edge;
    EXPECT_EQ(a[k].score, b[k].score) << a[k].edge;
    EXPECT_EQ(a[k].stage, b[k].stage) << a[k].edge;
  }
}

// Loops may join the same two vertices.
template <class Pose>
std::map<std::tuple<VertexId, VertexId, double>, Verdict> by_measurement(
    const spectral::EdgeVerdicts& verdicts, const PoseGraph<Pose>& graph) {
  std::map<std::tuple<VertexId, VertexId, double>, Verdict> result;
  for (const auto& row : verdicts) {
    const double measured = graph.constraints[row.edge].T_from_to.log()[0];
    result[{row.from, row.to, measured}] = row.verdict;
  }
  return result;
}

TYPED_TEST(OnlineConsensusOf, FinishesWithTheVerdictsOfTheBatch) {
  using Pose = TypeParam;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto graph = corrupted_graph<Pose>(seed);
    OnlineConsensus<Pose> online;
    add_all(online, graph);
    online.finish();
    expect_same(online.verdicts(), prune(graph).verdicts);
  }
}

// Nine of ten loops are false. What the batch prunes in the end is seldom kept meanwhile: a map
// that false loops draw together does not speak for them.
TYPED_TEST(OnlineConsensusOf, SeldomKeepsMeanwhileWhatIsFalse) {
  using Pose = TypeParam;
  const auto graph = corrupted_graph<Pose>(6, 120, 60, 9.0);
  std::map<std::int64_t, Verdict> last;
  for (const auto& row : prune(graph).verdicts) last[row.edge] = row.verdict;
  OnlineConsensus<Pose> online;
  std::map<std::int64_t, Verdict> now;
  std::size_t kept = 0;
  std::size_t wrong = 0;
  for (const auto& edge : graph.constraints) {
    for (const auto& change : add(online, graph, edge)) {
      now[change.verdict.edge] = change.verdict.verdict;
    }
    for (const auto& [loop, verdict] : now) {
      if (verdict != Verdict::keep) continue;
      ++kept;
      if (last[loop] == Verdict::prune) ++wrong;
    }
  }
  EXPECT_GT(kept, graph.constraints.size());
  EXPECT_LT(static_cast<double>(wrong), 0.02 * static_cast<double>(kept));
}

TYPED_TEST(OnlineConsensusOf, TellsEveryLoopAtOnceAndEveryChangeOnce) {
  using Pose = TypeParam;
  const auto graph = corrupted_graph<Pose>(4);
  OnlineConsensus<Pose> online;
  std::map<std::int64_t, Verdict> told;
  const auto hear = [&told](const std::vector<LoopChange>& changes) {
    for (const auto& change : changes) {
      EXPECT_EQ(change.first, told.count(change.verdict.edge) == 0);
      if (!change.first) {
        EXPECT_NE(told[change.verdict.edge], change.verdict.verdict);
      }
      EXPECT_FALSE(change.reason.empty());
      told[change.verdict.edge] = change.verdict.verdict;
    }
  };
  for (const auto& edge : graph.constraints) {
    hear(add(online, graph, edge));
    for (const auto& row : online.verdicts()) EXPECT_EQ(told.at(row.edge), row.verdict);
  }
  hear(online.finish());
  for (const auto& row : online.verdicts()) EXPECT_EQ(told.at(row.edge), row.verdict);
}

TYPED_TEST(OnlineConsensusOf, IsMostlyRightBeforeItFinishes) {
  using Pose = TypeParam;
  const auto graph = corrupted_graph<Pose>(5, 200, 80);
  OnlineConsensus<Pose> online;
  add_all(online, graph);
  const auto before = online.verdicts();
  online.finish();
  const auto after = online.verdicts();
  ASSERT_EQ(before.size(), after.size());
  int same = 0;
  for (std::size_t k = 0; k < after.size(); ++k) same += before[k].verdict == after[k].verdict;
  EXPECT_GE(same, 0.95 * static_cast<double>(after.size()));
}

TYPED_TEST(OnlineConsensusOf, EndsTheSameInWhateverOrderEdgesCome) {
  using Pose = TypeParam;
  const auto graph = corrupted_graph<Pose>(6);
  const auto expected = by_measurement(prune(graph).verdicts, graph);
  Random random(7);
  for (int trial = 0; trial < 4; ++trial) {
    auto shuffled = graph;
    for (std::size_t k = shuffled.constraints.size(); k > 1; --k) {
      std::swap(shuffled.constraints[k - 1], shuffled.constraints[random.index(k)]);
    }
    OnlineConsensus<Pose> online;
    add_all(online, shuffled);
    online.finish();
    EXPECT_EQ(by_measurement(online.verdicts(), shuffled), expected);
    expect_same(online.verdicts(), online.result().verdicts);
  }
}

TYPED_TEST(OnlineConsensusOf, CountsRepeatedAndReversedEdgesOnce) {
  using Pose = TypeParam;
  auto graph = corrupted_graph<Pose>(8);
  Random random(9);
  for (int k = 0; k < 10; ++k) {
    auto edge = graph.constraints[random.index(graph.constraints.size())];
    if (k % 2 == 0) {
      std::swap(edge.from, edge.to);
      edge.T_from_to = edge.T_from_to.inverse();
    }
    graph.constraints.push_back(edge);
  }
  graph.constraints.push_back(graph.constraints.back());
  graph.constraints.back().to = graph.constraints.back().from;
  OnlineConsensus<Pose> online;
  add_all(online, graph);
  EXPECT_EQ(online.verdicts().back().stage, "self-edge");
  online.finish();
  expect_same(online.verdicts(), prune(graph).verdicts);
}

TYPED_TEST(OnlineConsensusOf, GoesOnFromWhatWasSaved) {
  using Pose = TypeParam;
  const auto graph = corrupted_graph<Pose>(10);
  OnlineConsensus<Pose> whole;
  add_all(whole, graph);
  whole.finish();
  for (const double share : {0.0, 0.3, 0.9}) {
    OnlineConsensus<Pose> first;
    const auto half =
        static_cast<std::size_t>(share * static_cast<double>(graph.constraints.size()));
    std::ostringstream saved;
    std::ostringstream journal;
    for (std::size_t k = 0; k < half; ++k) {
      add(first, graph, graph.constraints[k]);
      first.journal(journal);
    }
    first.save(saved);
    if (half > 0) {
      EXPECT_EQ(saved.str(), journal.str());
    }
    std::istringstream in(saved.str() + "EDGE 0 1");  // the process ended here
    auto second = OnlineConsensus<Pose>::load(in);
    for (std::size_t k = half; k < graph.constraints.size(); ++k) {
      add(second, graph, graph.constraints[k]);
    }
    second.finish();
    expect_same(second.verdicts(), whole.verdicts());
  }
}

TYPED_TEST(OnlineConsensusOf, AnswersTheSameToTheSameCalls) {
  using Pose = TypeParam;
  const auto graph = corrupted_graph<Pose>(11, 150, 60);
  OnlineConsensus<Pose> one;
  OnlineConsensus<Pose> other;
  const auto a = add_all(one, graph);
  const auto b = add_all(other, graph);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].verdict.edge, b[k].verdict.edge);
    EXPECT_EQ(a[k].verdict.score, b[k].verdict.score);
    EXPECT_EQ(a[k].reason, b[k].reason);
  }
}

TYPED_TEST(OnlineConsensusOf, PlacesAllPoses) {
  using Pose = TypeParam;
  Random random(12);
  const auto made = random_loop_graph<Pose>(random, 60, 30, 0.0);
  OnlineConsensus<Pose> online;
  add_all(online, made.graph);
  EXPECT_LT(isotherm_test::worst_difference(online.graph().poses, made.truth), 1e-6);
}

// Loops that come after the last search that has ended move the map as well.
TYPED_TEST(OnlineConsensusOf, PlacesPosesByLoopsThatAreNew) {
  using Pose = TypeParam;
  Random random(18);
  const auto made = random_loop_graph<Pose>(random, 120, 60, 0.5);
  OnlineConsensus<Pose> online({.effort = 0.0});
  add_all(online, made.graph);
  const auto optimum = optimize(made.graph).poses;
  const auto odometry = odometry_poses(made.graph, edge_roles(made.graph));
  const double drift = isotherm_test::worst_difference(odometry, optimum);
  EXPECT_LT(isotherm_test::worst_difference(online.graph().poses, optimum), 0.5 * drift);
}

// A false loop is within the drift since the last search, but not within what a loop leaves of it
// that was kept meanwhile.
TYPED_TEST(OnlineConsensusOf, JudgesByLoopsThatWereKeptSince) {
  using Pose = TypeParam;
  const Index left = 100;  // the map
  const Index back = 130;
  for (const bool comes_back : {true, false}) {
    Random random(19);
    const auto made = random_loop_graph<Pose>(random, 140, 200, 1.0);
    const typename Pose::Matrix information = 1e4 * Pose::Matrix::Identity();
    OnlineConsensus<Pose> online({.effort = 0.0});
    const auto add_loop = [&](Index from, Index to, const Pose& error) {
      const Pose T_from_to = made.truth[from].inverse() * made.truth[to] * error;
      const auto& ids = made.graph.ids;
      return online.add_loop(ids[from], ids[to], T_from_to, information).front().verdict;
    };
    const auto& edges = made.graph.constraints;
    const auto on_map = [&](Index k) { return std::max(edges[k].from, edges[k].to) <= left; };
    const auto roles = edge_roles(made.graph);
    Index step = 0;
    for (; on_map(roles.odometry[step]); ++step) {
      add(online, made.graph, edges[roles.odometry[step]]);
    }
    for (const Index k : roles.candidates) {
      if (on_map(k)) add(online, made.graph, edges[k]);
    }
    online.catch_up();
    for (Index k = left; k <= back; ++k) {
      if (comes_back && k > back - 8) add_loop(k - 90, k, Pose());
      add(online, made.graph, edges[roles.odometry[step++]]);
    }
    typename Pose::Tangent wrong = Pose::Tangent::Zero();
    wrong[0] = 0.3;
    const auto told = add_loop(90, back + 1, Pose::exp(wrong));
    EXPECT_EQ(told.verdict == Verdict::prune, comes_back) << told.probability;
  }
}

TYPED_TEST(OnlineConsensusOf, PlacesPosesFromThoseThatAreTold) {
  using Pose = TypeParam;
  Random random(17);
  const auto made = random_loop_graph<Pose>(random, 30, 6, 0.0);
  OnlineConsensus<Pose> online;
  const Index told = 12;
  online.set_pose(made.graph.ids[told], made.truth[told]);
  add_all(online, made.graph);
  EXPECT_LT(isotherm_test::worst_difference(online.input().poses, made.truth), 1e-6);
  EXPECT_LT(isotherm_test::worst_difference(online.graph().poses, made.truth), 1e-6);
}

TYPED_TEST(OnlineConsensusOf, MeetsWhatSaysNothing) {
  using Pose = TypeParam;
  using Matrix = typename Pose::Matrix;
  OnlineConsensus<Pose> online;
  EXPECT_TRUE(online.finish().empty());
  EXPECT_TRUE(online.graph().ids.empty());
  // A loop before all else waits.
  auto changes = online.add_loop(5, 900, Pose(), Matrix::Identity());
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].verdict.verdict, Verdict::ambiguous);
  online.add_odometry(1, 2, Pose(), Matrix::Zero());
  online.add_odometry(2, 3, Pose(), Matrix::Zero());
  online.add_loop(1, 3, Pose(), Matrix::Zero());
  online.finish();
  EXPECT_EQ(online.verdicts().size(), 2U);
  EXPECT_THROW(online.add_loop(1, 3, Pose(), -Matrix::Identity()), InvalidArgument);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(online.add_loop(1, 3, Pose(), nan * Matrix::Identity()), InvalidArgument);
  EXPECT_EQ(online.verdicts().size(), 2U);
}

TYPED_TEST(OnlineConsensusOf, JoinsRobotsThatMeet) {
  using Pose = TypeParam;
  const auto graph = corrupted_graph<Pose>(13);
  const auto id = [&](Index v) {  // the second half is another robot's
    const bool second = 2 * v >= graph.vertex_count();
    return (static_cast<VertexId>(second ? 'b' : 'a') << 56) + static_cast<VertexId>(v);
  };
  OnlineConsensus<Pose> online;
  for (const auto& edge : graph.constraints) {
    if (std::abs(edge.from - edge.to) == 1 &&
        2 * std::max(edge.from, edge.to) == graph.vertex_count()) {
      continue;  // where the one ends and the other begins
    }
    online.add_edge(id(edge.from), id(edge.to), edge.T_from_to, edge.information);
  }
  online.finish();
  expect_same(online.verdicts(), prune(online.input()).verdicts);
}

TEST(OnlineConsensus, StopsWhereItIsAskedToAndGoesOn) {
  const auto graph = corrupted_graph<Pose2>(14);
  bool go_on = true;
  OnlineConsensus<Pose2> online({}, {.progress = [&](const Progress&) { return go_on; }});
  for (std::size_t k = 0; k < graph.constraints.size(); ++k) {
    go_on = k % 7 != 3;
    if (go_on) {
      add(online, graph, graph.constraints[k]);
    } else {
      EXPECT_THROW(add(online, graph, graph.constraints[k]), Cancelled);
    }
  }
  go_on = true;
  online.finish();
  expect_same(online.verdicts(), prune(graph).verdicts);
}

TEST(OnlineConsensus, RefusesStatesThatAreNone) {
  for (const std::string text :
       {"", "nothing\n", "isotherm-online/1 SE3\n", "isotherm-online/1 SE2\nEDGE 0 1 2 0 0\n",
        "isotherm-online/1 SE2\nHEDGE 1\n"}) {
    std::istringstream in(text);
    EXPECT_THROW(OnlineConsensus<Pose2>::load(in), ParseError) << text;
  }
}

}  // namespace
}  // namespace isotherm::slam
