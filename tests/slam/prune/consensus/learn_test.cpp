#include "prune/consensus/climb/learn.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"
#include "prune/consensus/objective/scale_prior.hpp"
#include "slam/loop_graph.hpp"

namespace isotherm::slam::detail {
namespace {

using isotherm_test::random_loop_graph;

template <class Pose>
class LessonOf : public testing::Test {
 protected:
  static constexpr int kLoops = 60;

  /// All loops accepted, or none.
  Explanation<Pose> assess(Assessment<Pose>& assessment, const CovarianceScale& scale,
                           const ScaleShares& shares, bool accepted = true) const {
    Explanation<Pose> now{.accepted = std::vector<bool>(kLoops, accepted), .scale = scale};
    now.shares = shares;
    now.weights.resize(kLoops);
    assessment.assess(now);
    return now;
  }

  /// Steps that vary by their errors alone; loops stay as they are, which is far off.
  void go_evenly() {
    typename Pose::Tangent ahead = Pose::Tangent::Zero();
    ahead[0] = 0.5;
    for (const Index k : edge_roles(graph_).odometry) {
      auto& step = graph_.constraints[k];
      const auto error = isotherm_test::random_error<Pose>(random_, step.information);
      const double onward = step.from < step.to ? 1.0 : -1.0;
      step.T_from_to = Pose::exp(onward * ahead) * Pose::exp(error);
    }
  }

  Random random_{5};
  PoseGraph<Pose> graph_ = random_loop_graph<Pose>(random_, 120, kLoops, 1.0).graph;
  Objective<Pose> objective_{graph_, edge_roles(graph_), 20};
};

using Poses = testing::Types<Pose2, Pose3>;
TYPED_TEST_SUITE(LessonOf, Poses);

// Expectation maximisation alone stays where all loops are called three times worse than most.
TYPED_TEST(LessonOf, CallsMostWhatMostAre) {
  using Pose = TypeParam;
  Assessment<Pose> assessment(this->objective_);
  const auto now = this->assess(assessment, {1.0, 1.0 / 3.0}, {{0.0, 60.0, 0.0, 0.0}});
  const auto lesson = learn(assessment, now, true);
  EXPECT_NEAR(lesson.scale.loops, 1.0, 0.3);
  EXPECT_GT(lesson.shares.loops[0], 0.9 * (lesson.shares.loops[0] + lesson.shares.loops[1]));
  EXPECT_GT(lesson.gain, 0.0);
}

// The peak of what is learnt from: cost and redundancy of each coordinate against the prior, though
// coordinates are told in units that are a thousand times off.
TYPED_TEST(LessonOf, ScalesOfCoordinatesAreWhereTheGradientIsZero) {
  using Pose = TypeParam;
  using Tangent = typename Pose::Tangent;
  for (auto& constraint : this->graph_.constraints) {
    constraint.information.template topRows<Pose::kDim>() *= 30.0;
    constraint.information.template leftCols<Pose::kDim>() *= 30.0;
  }
  const Objective<Pose> objective(this->graph_, edge_roles(this->graph_), 20);
  Assessment<Pose> assessment(objective);
  const auto now = this->assess(assessment, {1.0, 1.0}, {{60.0, 0.0, 0.0, 0.0}});
  const auto lesson = learn(assessment, now, false);
  const Tangent logs = log_scales(lesson.scale.odometry, lesson.shapes.odometry);
  ASSERT_GT(logs.maxCoeff() - logs.minCoeff(), 1.0);
  const Tangent fitted = now.odometry_cost.cwiseProduct((-logs).array().exp().matrix());
  const Tangent gradient =
      0.5 * (fitted - now.redundancy.odometry) - prior_precision<Tangent>() * logs;
  EXPECT_LT(gradient.cwiseAbs().maxCoeff(), 1e-6 * now.redundancy.odometry.maxCoeff());
}

// Loops that are far off would have odometry err more than its even steps vary.
TYPED_TEST(LessonOf, OdometryErrsNoMoreThanItsStepsVary) {
  using Pose = TypeParam;
  this->go_evenly();
  for (const bool same_shapes : {false, true}) {
    const Objective<Pose> objective(this->graph_, edge_roles(this->graph_), 20);
    Assessment<Pose> assessment(objective);
    const auto now = this->assess(assessment, {1.0, 1.0}, {{60.0, 0.0, 0.0, 0.0}});
    const auto lesson = learn(assessment, now, same_shapes);
    const typename Pose::Tangent logs = log_scales(lesson.scale.odometry, lesson.shapes.odometry);
    EXPECT_NEAR((logs - objective.most_odometry()).maxCoeff(), 0.0, 1e-9) << "as far as they may";
  }
}

// Nor where nothing else tells of it: no loop is accepted.
TYPED_TEST(LessonOf, OdometryTakenForWorseThanItsStepsVaryIsLearntFromThemAlone) {
  using Pose = TypeParam;
  this->go_evenly();
  for (const bool same_shapes : {false, true}) {
    const Objective<Pose> objective(this->graph_, edge_roles(this->graph_), 20);
    Assessment<Pose> assessment(objective);
    const auto now = this->assess(assessment, {100.0, 1.0}, {}, false);
    const auto lesson = learn(assessment, now, same_shapes);
    auto taken = now;
    taken.scale = lesson.scale;
    taken.shapes = lesson.shapes;
    ASSERT_TRUE(assessment.assess(taken));
    EXPECT_NEAR(lesson.gain, taken.evidence - now.evidence, 0.05 * lesson.gain);
    EXPECT_GT(lesson.gain, 100.0);
    const typename Pose::Tangent logs = log_scales(lesson.scale.odometry, lesson.shapes.odometry);
    EXPECT_LT((logs - objective.most_odometry()).maxCoeff(), 1e-9);
  }
}

}  // namespace
}  // namespace isotherm::slam::detail
