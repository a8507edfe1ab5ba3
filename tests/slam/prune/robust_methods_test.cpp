// The peers' methods on graphs whose false loops are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/optimize/optimize.hpp"
#include "isotherm/slam/prune/pcm.hpp"
#include "isotherm/slam/prune/prune.hpp"
#include "isotherm/slam/prune/rrr.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam {
namespace {

using isotherm_test::random_loop_graph;
using isotherm_test::random_tangent;
using spectral::Verdict;
using testing::ElementsAre;

template <class Pose>
struct Poisoned {
  PoseGraph<Pose> graph;
  Index first_false = 0;  // constraints from here on are false
};

// Precise loops, and false ones that contradict odometry, each other and the rest.
template <class Pose>
Poisoned<Pose> poisoned_graph(Random& random, int n, int loops, int false_loops) {
  Poisoned<Pose> made;
  made.graph = random_loop_graph<Pose>(random, n, loops, 0.1, 1e4).graph;
  made.first_false = made.graph.constraint_count();
  for (int l = 0; l < false_loops; ++l) {
    Constraint<Pose> wrong = made.graph.constraints.back();
    wrong.from = static_cast<Index>(random.index(static_cast<std::uint64_t>(n) / 2));
    wrong.to =
        wrong.from + 3 + static_cast<Index>(random.index(static_cast<std::uint64_t>(n) / 2 - 3));
    wrong.T_from_to = Pose::exp(random_tangent<Pose>(random, 1.0));
    made.graph.constraints.push_back(wrong);
  }
  return made;
}

const PruneOptions kMethods[] = {ScOptions{},  DcsOptions{}, CauchyOptions{},
                                 GncOptions{}, RrrOptions{}, PcmOptions{}};

// The method with its optimisations started at the graph's own poses.
PruneOptions from_file(PruneOptions method) {
  std::visit(
      [](auto& own) {
        if constexpr (requires { own.initialization; }) own.initialization = Initialization::file;
      },
      method);
  return method;
}

template <class Pose>
class RobustMethods : public testing::Test {
 protected:
  Random random{51};
};

using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(RobustMethods, Poses);

TYPED_TEST(RobustMethods, FindTheFalseLoops) {
  const auto made = poisoned_graph<TypeParam>(this->random, 60, 40, 15);
  const auto roles = edge_roles(made.graph);
  for (auto method : kMethods) {
    // Clusters of one: a cluster of true and false loops can fail as a whole.
    if (auto* own = std::get_if<RrrOptions>(&method)) own->rrr_cluster_gap = 1;
    const auto result = prune(made.graph, roles, method);
    ASSERT_EQ(result.verdicts.size(), 55u);
    int wrongly_kept = 0;
    int wrongly_pruned = 0;
    for (const auto& verdict : result.verdicts) {
      const bool is_false = verdict.edge >= made.first_false;
      if (is_false && verdict.verdict == Verdict::keep) ++wrongly_kept;
      if (!is_false && verdict.verdict == Verdict::prune) ++wrongly_pruned;
      EXPECT_EQ(verdict.verdict == Verdict::prune, verdict.score > verdict.threshold)
          << method_name(method) << " " << verdict.edge << " " << verdict.stage;
      EXPECT_FALSE(verdict.stage.empty());
    }
    EXPECT_EQ(wrongly_kept, 0) << method_name(method);
    EXPECT_LE(wrongly_pruned, 2) << method_name(method);
  }
}

TYPED_TEST(RobustMethods, LoopsPartFromTheirCluster) {
  // One cluster of true and false loops: as a whole it fails, loop by loop it does not.
  const auto made = poisoned_graph<TypeParam>(this->random, 60, 40, 15);
  const auto roles = edge_roles(made.graph);
  ASSERT_EQ(cluster_loops(made.graph, roles, 50).size(), 1u);
  const auto split = rrr(made.graph, roles, {.rrr_cluster_gap = 50});
  for (const auto& verdict : split) {
    EXPECT_EQ(verdict.verdict == Verdict::prune, verdict.edge >= made.first_false) << verdict.edge;
  }
  const auto whole = rrr(made.graph, roles, {.rrr_cluster_gap = 50, .rrr_split = false});
  EXPECT_LT(count(whole, Verdict::keep), 20);
}

TYPED_TEST(RobustMethods, StartWhereTheyAreTold) {
  using Pose = TypeParam;
  auto made = poisoned_graph<Pose>(this->random, 40, 30, 10);
  const auto roles = edge_roles(made.graph);
  for (const auto& method : kMethods) {
    if (std::holds_alternative<PcmOptions>(method)) continue;  // optimises nothing
    made.graph.poses.clear();
    EXPECT_THROW(prune(made.graph, roles, from_file(method)), InvalidArgument)
        << method_name(method);
    made.graph.poses = initial_poses(made.graph, roles, Initialization::odometry);
    const auto result = prune(made.graph, roles, from_file(method));
    EXPECT_EQ(result.verdicts.size(), roles.candidates.size()) << method_name(method);
  }
  // The scores are those of an optimisation from there.
  const auto verdicts = prune(made.graph, roles, from_file(DcsOptions{})).verdicts;
  const auto optimum =
      optimize(made.graph, {.kernel = RobustKernel::dcs, .initialization = Initialization::file});
  for (const auto& verdict : verdicts) {
    EXPECT_DOUBLE_EQ(verdict.score, optimum.chi2[verdict.edge]);
  }
}

TYPED_TEST(RobustMethods, KeepAGraphWithoutNoise) {
  const auto made = random_loop_graph<TypeParam>(this->random, 40, 30, 0.0);
  const auto roles = edge_roles(made.graph);
  for (const auto& method : kMethods) {
    const auto result = prune(made.graph, roles, method);
    EXPECT_EQ(count(result.verdicts, Verdict::keep), 30) << method_name(method);
  }
}

TYPED_TEST(RobustMethods, AreDefinedOnDegenerateGraphs) {
  using Pose = TypeParam;
  std::vector<PoseGraph<Pose>> graphs(3);
  graphs[1].ids = {3};
  graphs[2] = random_loop_graph<Pose>(this->random, 10, 0, 1.0).graph;  // no loops
  // Two chains that only a loop joins, a loop to itself, zero information.
  PoseGraph<Pose> odd = random_loop_graph<Pose>(this->random, 12, 6, 0.1).graph;
  odd.constraints.erase(odd.constraints.begin() + 5);
  Constraint<Pose> bridge = odd.constraints.front();
  bridge.from = 0;
  bridge.to = 11;
  odd.constraints.push_back(bridge);
  bridge.to = 0;
  odd.constraints.push_back(bridge);
  bridge.to = 5;
  bridge.information.setZero();
  odd.constraints.push_back(bridge);
  graphs.push_back(odd);
  for (const auto& graph : graphs) {
    const auto roles = edge_roles(graph);
    for (const auto& method : kMethods) {
      const auto result = prune(graph, roles, method);
      EXPECT_EQ(result.verdicts.size(), roles.candidates.size()) << method_name(method);
    }
  }
}

TYPED_TEST(RobustMethods, SwitchesEndAtTheirClosedForm) {
  // At the joint optimum each switch is width / (width + chi2).
  const auto made = poisoned_graph<TypeParam>(this->random, 50, 40, 8);
  for (const double width : {1.0, 4.0}) {
    const auto result = optimize(
        made.graph, {.kernel = RobustKernel::sc, .kernel_width = width, .cost_tolerance = 1e-12});
    ASSERT_EQ(result.status, OptimizeStatus::converged);
    for (const Index k : edge_roles(made.graph).candidates) {
      EXPECT_NEAR(std::sqrt(result.weight[k]), width / (width + result.chi2[k]), 1e-4) << k;
    }
  }
}

TYPED_TEST(RobustMethods, GraduatedWeightsEndAtTheOriginalLoss) {
  const auto made = poisoned_graph<TypeParam>(this->random, 50, 40, 20);
  const auto truncated = optimize(made.graph, {.kernel = RobustKernel::gnc});
  for (const Index k : edge_roles(made.graph).candidates) {
    EXPECT_EQ(truncated.weight[k] < 0.5, k >= made.first_false);
    EXPECT_TRUE(truncated.weight[k] < 1e-3 || truncated.weight[k] > 1 - 1e-3);
  }
  double loss = 0.0;
  for (const Index k : edge_roles(made.graph).odometry) loss += truncated.chi2[k];
  for (const Index k : edge_roles(made.graph).candidates) {
    loss += std::min(truncated.chi2[k], default_kernel_width(RobustKernel::gnc, TypeParam::kDof));
  }
  EXPECT_NEAR(truncated.final_cost, loss, 1e-9 * loss);
  EXPECT_LT(truncated.final_cost, truncated.initial_cost);
  const auto smooth = optimize(made.graph, {.kernel = RobustKernel::gnc_gm});
  for (const Index k : edge_roles(made.graph).candidates) {
    EXPECT_EQ(smooth.weight[k] < 0.5, k >= made.first_false);
  }
}

TEST(ClusterLoops, JoinsThroughNeighboursAtBothEnds) {
  PoseGraph<Pose2> graph;
  for (VertexId id = 0; id < 1000; ++id) graph.ids.push_back(id);
  const auto add = [&](Index from, Index to) {
    Constraint<Pose2> loop;
    loop.from = from;
    loop.to = to;
    graph.constraints.push_back(loop);
  };
  add(100, 500);
  add(540, 140);  // the other way round, still close
  add(180, 580);  // through the second
  add(100, 700);  // one end only
  add(300, 900);
  const auto clusters = cluster_loops(graph, edge_roles(graph), 50);
  EXPECT_THAT(clusters, ElementsAre(ElementsAre(0, 1, 2), ElementsAre(3), ElementsAre(4)));
}

TEST(Pcm, TheOrderOfTheFilePlaysNoPart) {
  Random random(3);
  // So many false loops that several cliques are largest.
  const auto made = poisoned_graph<Pose2>(random, 60, 4, 60);
  const auto roles = edge_roles(made.graph);
  const auto verdicts = pcm(made.graph, roles).verdicts;
  for (int k = 0; k < 10; ++k) {
    auto shuffled = made.graph;
    std::vector<Index> place = roles.candidates;
    for (std::size_t c = place.size(); c > 1; --c) {
      std::swap(place[c - 1], place[random.index(c)]);
    }
    for (std::size_t c = 0; c < place.size(); ++c) {
      shuffled.constraints[place[c]] = made.graph.constraints[roles.candidates[c]];
    }
    const auto again = pcm(shuffled, edge_roles(shuffled)).verdicts;
    for (std::size_t c = 0; c < place.size(); ++c) {
      const auto at = static_cast<std::size_t>(place[c] - roles.candidates.front());
      EXPECT_EQ(again[at].verdict, verdicts[c].verdict) << k << " " << c;
    }
  }
}

TEST(RobustMethods, OptionsOutOfRange) {
  const PoseGraph<Pose2> graph;
  EXPECT_THROW(rrr(graph, {}, {.rrr_cluster_gap = 0}), InvalidArgument);
  EXPECT_THROW(rrr(graph, {}, {.rrr_confidence = 1.0}), InvalidArgument);
  EXPECT_THROW(rrr(graph, {}, {.rrr_iterations = 0}), InvalidArgument);
  EXPECT_THROW(pcm(graph, {}, {.pcm_odometry_confidence = 0.0}), InvalidArgument);
  EXPECT_THROW(pcm(graph, {}, {.pcm_pair_confidence = 1.0}), InvalidArgument);
  EXPECT_THROW(pcm(graph, {}, {.pcm_clique_budget = -1}), InvalidArgument);
}

}  // namespace
}  // namespace isotherm::slam
