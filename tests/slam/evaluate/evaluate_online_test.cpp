#include "isotherm/slam/evaluate/evaluate_online.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"

namespace isotherm::slam {
namespace {

using spectral::Verdict;
using testing::DoubleEq;
using testing::ElementsAre;

EdgeLabel labelled(std::int64_t edge, Label what) { return {.edge = edge, .label = what}; }

const std::vector<EdgeLabel> kLabels = {labelled(10, Label::correct),
                                        labelled(20, Label::incorrect),
                                        labelled(30, Label::correct), labelled(40, Label::ignore)};

// A true loop and a false one are kept at first; the false one is found out ten edges later, while
// another true one waits for ten.
const std::vector<TimedVerdict> kCourse = {
    {10, Verdict::keep, 10, 8},       {20, Verdict::keep, 20, 16},  {20, Verdict::prune, 30, 24},
    {30, Verdict::ambiguous, 30, 24}, {40, Verdict::prune, 35, 28}, {30, Verdict::keep, 40, 32}};

TEST(EvaluateOnline, HasPrecisionAndRecallFromStepToStep) {
  const auto metrics = evaluate_online(kCourse, kLabels, 50);
  ASSERT_EQ(metrics.steps.size(), 4U);
  const auto& [first, second, third, last] =
      std::tie(metrics.steps[0], metrics.steps[1], metrics.steps[2], metrics.steps[3]);
  EXPECT_EQ(first.at, 10);
  EXPECT_EQ(first.precision(), 1.0);
  EXPECT_EQ(second.precision(), 0.5);
  EXPECT_EQ(second.recall(), 1.0);
  EXPECT_EQ(third.precision(), 1.0);
  EXPECT_EQ(third.recall(), 0.5);
  EXPECT_EQ(third.missed, 1);
  EXPECT_EQ(last.poses, 32);
  EXPECT_EQ(last.recall(), 1.0);
  EXPECT_THAT(metrics.mean_precision, DoubleEq((1.0 + 0.5 + 1.0 + 1.0) / 4.0));
  EXPECT_THAT(metrics.mean_recall, DoubleEq((1.0 + 1.0 + 0.5 + 1.0) / 4.0));
}

TEST(EvaluateOnline, KeepsAtEvenOddsWhatIsLikelierTrue) {
  const auto decided = decided_at_even_odds({{1, Verdict::ambiguous, 1, 1, 0.6},
                                             {2, Verdict::ambiguous, 2, 2, 0.4},
                                             {3, Verdict::ambiguous, 3, 3, std::nullopt}});
  EXPECT_EQ(decided[0].verdict, Verdict::keep);
  EXPECT_EQ(decided[1].verdict, Verdict::prune);
  EXPECT_EQ(decided[2].verdict, Verdict::ambiguous);
}

TEST(EvaluateOnline, CountsPosesUntilTheLastChangeOfLoopsThatEndRight) {
  const auto metrics = evaluate_online(kCourse, kLabels, 50);
  EXPECT_THAT(metrics.delays, ElementsAre(0, 8, 8));
  EXPECT_EQ(metrics.right, 3);
  EXPECT_EQ(metrics.ignored, 1);
  auto course = kCourse;
  course.push_back({10, Verdict::prune, 50, 40});
  course.push_back({20, Verdict::ambiguous, 50, 40});
  const auto worse = evaluate_online(course, kLabels, 50);
  EXPECT_THAT(worse.delays, ElementsAre(8));
  EXPECT_EQ(worse.wrong, 1);
  EXPECT_EQ(worse.undecided, 1);
  EXPECT_EQ(worse.mean_precision, metrics.mean_precision);  // what the end says lasts no time
}

TEST(EvaluateOnline, MeetsEmptyAndOddInput) {
  const auto nothing = evaluate_online({}, {}, 0);
  EXPECT_EQ(nothing.mean_recall, 1.0);
  EXPECT_TRUE(nothing.delays.empty());
  EXPECT_EQ(evaluate_online(kCourse, {}, 50).ignored, 4);
  EXPECT_THROW(evaluate_online({{1, Verdict::keep, 5, 1}, {2, Verdict::keep, 4, 1}}, {}, 9),
               InvalidArgument);
  EXPECT_THROW(evaluate_online({}, {labelled(1, Label::correct), labelled(1, Label::correct)}, 9),
               InvalidArgument);
}

}  // namespace
}  // namespace isotherm::slam
