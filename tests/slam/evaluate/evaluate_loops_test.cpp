#include "isotherm/slam/evaluate/evaluate_loops.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"

namespace isotherm::slam {
namespace {

using spectral::EdgeVerdict;
using spectral::Verdict;

EdgeVerdict verdict(std::int64_t edge, Verdict decided, double score) {
  return {edge, 1, 2, decided, score, 0.5, "test"};
}

EdgeLabel label(std::int64_t edge, Label value) { return {edge, 1, 2, value}; }

TEST(EvaluateLoops, CountsEveryCell) {
  const auto metrics = evaluate_loops(
      {verdict(3, Verdict::prune, 0.9), verdict(4, Verdict::prune, 0.8),
       verdict(5, Verdict::prune, 0.7), verdict(6, Verdict::keep, 0.1),
       verdict(7, Verdict::keep, 0.2), verdict(8, Verdict::ambiguous, 0.5),
       verdict(9, Verdict::ambiguous, 0.5), verdict(10, Verdict::prune, 0.6)},
      {label(3, Label::incorrect), label(4, Label::incorrect), label(5, Label::correct),
       label(6, Label::correct), label(7, Label::incorrect), label(8, Label::incorrect),
       label(9, Label::correct), label(10, Label::ignore)});
  EXPECT_EQ(metrics.tp, 2);
  EXPECT_EQ(metrics.fp, 1);
  EXPECT_EQ(metrics.fn, 2);
  EXPECT_EQ(metrics.tn, 2);
  EXPECT_EQ(metrics.ambiguous, 2);
  EXPECT_EQ(metrics.ignored, 1);
  EXPECT_DOUBLE_EQ(metrics.precision(), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(metrics.recall(), 0.5);
  EXPECT_DOUBLE_EQ(metrics.f1(), 4.0 / 7.0);
  // Of 4 x 3 pairs: 0.9 and 0.8 win all three, 0.5 ties one and wins one, 0.2
  // wins one.
  EXPECT_DOUBLE_EQ(metrics.auc, (3 + 3 + 1.5 + 1) / 12.0);
}

TEST(EvaluateLoops, NothingPrunedNothingWrong) {
  const auto metrics = evaluate_loops({verdict(0, Verdict::keep, 0.0)}, {label(0, Label::correct)});
  EXPECT_EQ(metrics.precision(), 1.0);
  EXPECT_EQ(metrics.recall(), 1.0);
  EXPECT_TRUE(std::isnan(metrics.auc));
  EXPECT_EQ(evaluate_loops({}, {}).f1(), 1.0);
}

TEST(EvaluateLoops, InfiniteScoresRankHighest) {
  const double infinity = std::numeric_limits<double>::infinity();
  const auto metrics =
      evaluate_loops({verdict(0, Verdict::prune, infinity), verdict(1, Verdict::keep, 7.0)},
                     {label(0, Label::incorrect), label(1, Label::correct)});
  EXPECT_EQ(metrics.auc, 1.0);
}

TEST(EvaluateLoops, RejectsFilesThatDoNotBelongTogether) {
  const auto keep = verdict(0, Verdict::keep, 0.0);
  const auto correct = label(0, Label::correct);
  EXPECT_THROW(evaluate_loops({keep}, {}), InvalidArgument);
  EXPECT_THROW(evaluate_loops({}, {correct}), InvalidArgument);
  EXPECT_THROW(evaluate_loops({keep, keep}, {correct}), InvalidArgument);
  EXPECT_THROW(evaluate_loops({keep}, {correct, correct}), InvalidArgument);
  auto other = correct;
  other.to = 99;
  EXPECT_THROW(evaluate_loops({keep}, {other}), InvalidArgument);
  const auto nan = verdict(0, Verdict::keep, std::nan(""));
  EXPECT_THROW(evaluate_loops({nan}, {correct}), InvalidArgument);
}

}  // namespace
}  // namespace isotherm::slam
