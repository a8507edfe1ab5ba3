// The main job from file to file.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run_command.hpp"

namespace {

using isotherm_test::CommandTest;
using isotherm_test::read_text;
using testing::HasSubstr;

class PruneCommand : public CommandTest {
 protected:
  void make_corrupted() const {
    run_ok("simulate city --poses 600 --loops 250 --seed 3 -o clean.g2o --ground-truth gt.g2o");
    run_ok(
        "corrupt clean.g2o --ground-truth gt.g2o --count 120 --seed 3 -o bad.g2o --labels "
        "labels.csv");
  }
};

TEST_F(PruneCommand, FindsFalseLoopsOfASimulatedCity) {
  make_corrupted();
  for (const std::string method : {"consensus", "heat", "chi2"}) {
    run_ok("prune bad.g2o --method " + method +
           " -o pruned.g2o --verdicts verdicts.csv --json result.json");
    const auto metrics = run_ok("eval loops verdicts.csv labels.csv");
    // All figures at this seed are 0.98 or better.
    EXPECT_THAT(metrics, testing::ContainsRegex("precision (0.9[5-9]|1.0)")) << metrics;
    EXPECT_THAT(metrics, testing::ContainsRegex("recall (0.9[5-9]|1.0)")) << metrics;
    const auto json = read_text(folder / "result.json");
    for (const char* key : {"isotherm.prune/1", "\"method\"", "\"candidates\": 370", "\"kept\"",
                            "\"pruned\"", "\"ambiguous\"", "\"seconds\"", "\"options\""}) {
      EXPECT_THAT(json, HasSubstr(key));
    }
  }
}

TEST_F(PruneCommand, VerdictsHaveOneRowACandidateInFileOrder) {
  make_corrupted();
  run_ok("prune bad.g2o --verdicts verdicts.csv");
  const auto text = read_text(folder / "verdicts.csv");
  EXPECT_THAT(text, testing::StartsWith("edge,from,to,verdict,score,threshold,stage\n599,"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 371);
}

TEST_F(PruneCommand, LabelAgreesWithTheLabelsOfCorrupt) {
  make_corrupted();
  run_ok("label bad.g2o --ground-truth gt.g2o -o by_truth.csv");
  run_ok("prune bad.g2o --verdicts verdicts.csv");
  const auto by_corrupt = run_ok("eval loops verdicts.csv labels.csv");
  EXPECT_THAT(by_corrupt, HasSubstr("AUC 1.0000"));
  EXPECT_THAT(run_ok("eval loops verdicts.csv by_truth.csv"), HasSubstr("AUC "));
}

TEST_F(PruneCommand, SameBytesForAnyNumberOfThreads) {
  make_corrupted();
  run_ok("prune bad.g2o --threads 1 -o one.g2o --verdicts one.csv");
  run_ok("prune bad.g2o --threads 2 -o two.g2o --verdicts two.csv");
  EXPECT_EQ(read_text(folder / "one.g2o"), read_text(folder / "two.g2o"));
  EXPECT_EQ(read_text(folder / "one.csv"), read_text(folder / "two.csv"));
}

TEST_F(PruneCommand, GraphsWithoutLoops) {
  run_ok("simulate city --poses 10 --loops 0 -o a.g2o");
  for (const std::string method : {"consensus", "heat", "chi2"}) {
    run_ok("prune a.g2o --method " + method + " -o b.g2o --verdicts v.csv");
    EXPECT_EQ(read_text(folder / "v.csv"), "edge,from,to,verdict,score,threshold,stage\n");
    EXPECT_EQ(read_text(folder / "a.g2o"), read_text(folder / "b.g2o"));
  }
}

}  // namespace
