#include "prune/consensus/climb/assessment.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"
#include "prune/consensus/objective/loop_gain.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam::detail {
namespace {

using isotherm_test::random_loop_graph;

template <class Pose>
class AssessmentOf : public testing::Test {
 protected:
  static constexpr int kLoops = 40;

  /// How often the density of near pairs is found while the loops that are accepted, the first
  /// ones, come to be as many as `counts` say.
  double times_found(const std::vector<int>& counts, bool held) {
    Assessment<Pose> assessment(objective_);
    assessment.hold_nearness(held);
    for (const int count : counts) {
      Explanation<Pose> now{.accepted = std::vector<bool>(kLoops, false)};
      std::fill_n(now.accepted.begin(), count, true);
      now.weights.resize(kLoops);
      assessment.assess(now);
      last_ = assessment.findings().near;
    }
    EXPECT_EQ(assessment.nearness_found().assessments, static_cast<double>(counts.size()));
    return assessment.nearness_found().times;
  }

  /// That the first `count` loops are true, found as a climb does: from nothing.
  Explanation<Pose> accepting(Assessment<Pose>& assessment, int count, double scale = 1.0,
                              const ScaleShares& shares = {}) {
    Explanation<Pose> now{
        .accepted = std::vector<bool>(kLoops, false), .scale = {1.0, scale}, .shares = shares};
    now.weights.resize(kLoops);
    assessment.assess(now);
    std::fill_n(now.accepted.begin(), count, true);
    assessment.assess(now);
    return now;
  }

  Random random_{3};
  PoseGraph<Pose> graph_ = random_loop_graph<Pose>(random_, 80, kLoops, 1.0).graph;
  Objective<Pose> objective_{graph_, edge_roles(graph_), 20};
  typename Objective<Pose>::NearByClass last_{};
};

// Where odometry is poor a loop has little to be held against: what is left of a step would count
// many times over there.
template <class Pose>
void expect_settled_standings(std::uint64_t seed) {
  Random random(seed);
  const auto graph = random_loop_graph<Pose>(random, 60, 8, 1.0).graph;
  const Objective<Pose> objective(graph, edge_roles(graph), 20);
  Assessment<Pose> assessment(objective);
  Explanation<Pose> now{.accepted = std::vector<bool>(8, true), .scale = {1e4, 1e-3}};
  now.weights.resize(8);
  assessment.assess(now);
  const auto standings = now.standings;
  for (int again = 0; again < 3; ++again) assessment.assess(now);
  for (std::size_t k = 0; k < standings.size(); ++k) {
    EXPECT_NEAR(standings[k].log_odds, now.standings[k].log_odds, 1.0) << k << " of " << seed;
  }
}

using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(AssessmentOf, Poses);

TYPED_TEST(AssessmentOf, FindsWhatIsNearEveryTimeUnlessItIsHeld) {
  EXPECT_EQ(this->times_found({20, 21, 20}, false), 3.0);
  EXPECT_EQ(this->times_found({20, 21, 20}, true), 1.0);
}

TYPED_TEST(AssessmentOf, FindsWhatIsNearAnewOfManyMoreOrFewerLoops) {
  EXPECT_EQ(this->times_found({0, 5, 40}, true), 2.0);
  EXPECT_EQ(this->times_found({40, 36, 10}, true), 2.0);
}

TYPED_TEST(AssessmentOf, KnowsWhatIsNearAtTheSameLoopsAlike) {
  this->times_found({0, 40}, true);
  const auto held = this->last_;
  this->times_found({0, 40}, false);
  EXPECT_EQ(held, this->last_);
}

TYPED_TEST(AssessmentOf, SettlesUntilStandingsDo) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) expect_settled_standings<TypeParam>(seed);
}

// Of an accepted loop, against the same of an estimate that does not hold it.
TYPED_TEST(AssessmentOf, WeighsLoopsAsTheOthersSay) {
  using Pose = TypeParam;
  Assessment<Pose> assessment(this->objective_);
  Explanation<Pose> now = this->accepting(assessment, this->kLoops);
  const auto& graph = assessment.graph();
  for (const std::size_t k : {0, 7, 20, 39}) {
    Explanation<Pose> others = now;
    others.accepted[k] = false;
    Assessment<Pose> without(this->objective_);
    without.assess(others);
    const auto& found = without.findings();
    const Belief<Pose> belief{without.estimate().residual(graph.loops[k]), found.covariances[k]};
    const auto gain =
        loop_gain<Pose>(belief, {graph.loops[k].covariance, graph.loops[k].covariance},
                        found.mixture, this->objective_.scale_deviation(others.redundancy));
    // The others settle anew.
    EXPECT_NEAR(now.standings[k].weight.learnt, gain.weight.learnt, 0.05) << k;
    EXPECT_LT(gain.weight.learnt, 1.0) << k;
  }
}

// The same odometry in two chains, the later one numbered backwards, and a trusted edge between.
// Without a bias, which chains alone have.
TYPED_TEST(AssessmentOf, WeighsLoopsAcrossATrustedEdgeAsAlongAChain) {
  const auto roles = edge_roles(this->graph_);
  auto apart = this->graph_;
  for (auto& constraint : apart.constraints) {
    for (Index* end : {&constraint.from, &constraint.to}) *end = *end < 40 ? *end : 119 - *end;
  }
  std::vector<Standing> standings;
  for (const auto& graph : {this->graph_, apart}) {
    const Objective<TypeParam> objective(graph, roles, 20, false);
    Assessment<TypeParam> assessment(objective);
    const auto now = this->accepting(assessment, 0);
    standings.insert(standings.end(), now.standings.begin(), now.standings.end());
  }
  for (int k = 0; k < this->kLoops; ++k) {
    EXPECT_NEAR(standings[k].chi2, standings[k + this->kLoops].chi2, 1e-6 * standings[k].chi2) << k;
  }
}

// One of them by too little for a bound to tell.
TYPED_TEST(AssessmentOf, RefutesByBoundsWhatIsRefutedExactly) {
  using Pose = TypeParam;
  auto graph = this->graph_;
  const EdgeRoles roles = edge_roles(graph);
  for (const std::size_t k : {30, 33, 36, 39}) {
    auto& T = graph.constraints[roles.candidates[k]].T_from_to;
    T = T * Pose::exp(Pose::Tangent::Constant(k == 30 ? 0.03 : 0.5));
  }
  const Objective<Pose> objective(graph, roles, 1);
  Assessment<Pose> assessment(objective);
  Explanation<Pose> now{.accepted = std::vector<bool>(this->kLoops, true)};
  for (const std::size_t k : {30, 33, 36, 39}) now.accepted[k] = false;
  now.weights.resize(this->kLoops);
  assessment.assess(now);
  for (const std::size_t k : {30, 33, 36, 39}) {
    const auto& link = assessment.graph().loops[k];
    const auto exact = assessment.estimate().residual_covariances({&link})[0];
    const auto gain = loop_gain<Pose>(
        {assessment.belief(static_cast<Index>(k)).r, exact}, {link.covariance, link.covariance},
        assessment.findings().mixture, objective.scale_deviation(now.redundancy));
    EXPECT_LE(now.standings[k].chi2, gain.chi2 * (1.0 + 1e-9)) << k;
    EXPECT_EQ(now.standings[k].evidence < -kNoDigit, k != 30) << k;
    EXPECT_EQ(gain.log_density - assessment.log_alternative(static_cast<Index>(k)) < -kNoDigit,
              k != 30)
        << k;
  }
}

// Weights and shares take turns, each the best given the other.
TYPED_TEST(AssessmentOf, FindsMoreEvidenceEachTime) {
  using Pose = TypeParam;
  for (const double scale :
       {1.0, 1.0 / 3.0, 1.0 / 30.0}) {  // sharper than stated: loops of all kinds
    Assessment<Pose> assessment(this->objective_);
    auto now = this->accepting(assessment, this->kLoops, scale, {{20.0, 10.0, 10.0, 0.0}});
    for (int again = 0; again < 9; ++again) {
      const double before = now.evidence;
      now.shares = now.found;
      assessment.assess(now);
      EXPECT_GT(now.evidence, before - 1e-2) << scale;
    }
  }
}

}  // namespace
}  // namespace isotherm::slam::detail
