// The main job from file to file.
#include <cstdlib>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "run_command.hpp"

namespace {

using isotherm_test::CommandTest;
using isotherm_test::read_text;
using testing::HasSubstr;
using testing::Not;

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

// What consensus leaves explains more than what it pruned, and about as much as the truth.
TEST_F(PruneCommand, AnswersAreComparedByTheirEvidence) {
  make_corrupted();
  const auto evidence_of = [&](const std::string& answer) {
    const auto json = run_ok("eval evidence bad.g2o " + answer + " --json -");
    return nlohmann::json::parse(json)["log_evidence"].get<double>();
  };
  run_ok("prune bad.g2o --verdicts found.csv");
  run_ok("prune bad.g2o --method chi2 --verdicts chi2.csv");
  const double found = evidence_of("--verdicts found.csv");
  EXPECT_NEAR(found, evidence_of("--labels labels.csv"), 0.02 * found);
  EXPECT_GE(found, evidence_of("--verdicts chi2.csv") - 1.0);
  EXPECT_EQ(run("eval evidence bad.g2o").code, 2);
}

TEST_F(PruneCommand, VerdictsHaveOneRowACandidateInFileOrder) {
  make_corrupted();
  const std::string columns = "edge,from,to,verdict,score,threshold,stage";
  for (const auto& [method, added] : {std::pair("consensus", ",probability"), {"chi2", ""}}) {
    run_ok(std::string("prune bad.g2o --verdicts verdicts.csv --method ") + method);
    const auto text = read_text(folder / "verdicts.csv");
    EXPECT_THAT(text, testing::StartsWith(columns + added + "\n599,"));
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 371);
  }
}

TEST_F(PruneCommand, VerdictsOfConsensusAreProbabilitiesInEveryDocument) {
  make_corrupted();
  run_ok("prune bad.g2o --verdicts verdicts.csv --json result.json");
  const auto result = nlohmann::json::parse(read_text(folder / "result.json"))["consensus"];
  EXPECT_EQ(result["settled"], true);
  EXPECT_FALSE(result["moves"].empty());
  for (const char* scale : {"odometry_scale", "loop_scale", "rotation_scale"}) {
    EXPECT_NEAR(result[scale].get<double>(), 1.0, 0.3) << scale;
  }
  std::istringstream rows(read_text(folder / "verdicts.csv"));
  std::string row;
  std::getline(rows, row);
  for (const auto& loop : result["loops"]) {
    ASSERT_TRUE(std::getline(rows, row));
    const double probability = loop["probability"];
    EXPECT_EQ(std::stod(row.substr(row.rfind(',') + 1)), probability);
    EXPECT_EQ(loop["edge"], std::stoi(row));
    EXPECT_TRUE(loop["connected"]);
    const bool pruned = row.find(",prune,") != std::string::npos;
    EXPECT_EQ(pruned, probability < 0.01);
    EXPECT_EQ(pruned, !loop["conflicts"].empty());
  }
}

TEST_F(PruneCommand, LabelAgreesWithTheLabelsOfCorrupt) {
  make_corrupted();
  run_ok("label bad.g2o --ground-truth gt.g2o -o by_truth.csv");
  run_ok("prune bad.g2o --verdicts verdicts.csv");
  EXPECT_EQ(read_text(folder / "by_truth.csv"), read_text(folder / "labels.csv"));
  // The false loops of this city are far from where they belong: none is missed.
  const auto by_truth = run_ok("eval loops verdicts.csv by_truth.csv");
  EXPECT_THAT(by_truth, HasSubstr("precision 1.0000  recall 1.0000  F1 1.0000  AUC 1.0000"));
  EXPECT_THAT(by_truth, HasSubstr("pruned: 120 incorrect, 0 correct; left: 0 incorrect, 250 "));
}

TEST_F(PruneCommand, ReportLeavesTheOutputAsItIs) {
  make_corrupted();
  run_ok("prune bad.g2o -o plain.g2o --verdicts plain.csv");
  run_ok("prune bad.g2o -o explained.g2o --verdicts explained.csv --report report.json");
  EXPECT_EQ(read_text(folder / "plain.g2o"), read_text(folder / "explained.g2o"));
  EXPECT_EQ(read_text(folder / "plain.csv"), read_text(folder / "explained.csv"));
}

TEST_F(PruneCommand, HelpShowsTheOptionsOfTheMethodThatIsNamed) {
  const auto general = run_ok("prune --help");
  EXPECT_THAT(general, HasSubstr("--keep-ambiguous"));
  EXPECT_THAT(general, HasSubstr("--method NAME --help"));
  EXPECT_THAT(general, Not(HasSubstr("--significance")));
  for (const char* line : {"prune --method chi2 --help", "prune --help --method chi2"}) {
    const auto help = run_ok(line);
    EXPECT_THAT(help, HasSubstr("Method chi2"));
    EXPECT_THAT(help, testing::ContainsRegex("--significance [^[]*\\[0.01\\]"));
    EXPECT_THAT(help, Not(HasSubstr("--scales")));
  }
  EXPECT_THAT(run_ok("prune --preset datta2016 --help"), HasSubstr("[mean-sigma]"));
}

TEST_F(PruneCommand, RefusesOptionsOfAnotherMethod) {
  run_ok("simulate city --poses 10 --loops 2 -o a.g2o");
  const auto refused = run("prune a.g2o --tolerance 1e-3 -o b.g2o");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--tolerance: is an option of heat, not of method consensus"));
  EXPECT_FALSE(std::filesystem::exists(folder / "b.g2o"));
  EXPECT_EQ(run("prune a.g2o --method gnc --no-curve-rarity").code, 2);
  // A configuration may speak of several methods; what it says must have the right type.
  isotherm_test::write_text(folder / "c.json", R"({"tolerance": 0.5, "kernel_width": 3})");
  EXPECT_THAT(run_ok("prune a.g2o --config c.json --dump-config"), Not(HasSubstr("tolerance")));
  EXPECT_THAT(run_ok("prune a.g2o --config c.json --method dcs --dump-config"),
              HasSubstr("\"kernel_width\": 3.0"));
  isotherm_test::write_text(folder / "c.json", R"({"tolerance": "small"})");
  EXPECT_EQ(run("prune a.g2o --config c.json --dump-config").code, 2);
}

TEST_F(PruneCommand, PresetSelectsItsMethodOrIsRefused) {
  const auto preset = run_ok("prune a.g2o --preset datta2016 --konst 2 --dump-config");
  EXPECT_THAT(preset, HasSubstr("\"method\": \"heat\""));
  EXPECT_THAT(preset, HasSubstr("\"threshold\": \"mean-sigma\""));
  EXPECT_THAT(preset, HasSubstr("2.0"));
  EXPECT_EQ(run_ok("prune a.g2o --method heat --preset datta2016 --konst 2 --dump-config"), preset);
  const auto refused = run("prune a.g2o --preset datta2016 --method consensus --dump-config");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("datta2016 is of method heat, not of consensus"));
  isotherm_test::write_text(folder / "c.json", R"({"method": "chi2"})");
  EXPECT_EQ(run("prune a.g2o --preset datta2016 --config c.json --dump-config").code, 2);
  EXPECT_EQ(run("prune a.g2o --preset nobody2000 --dump-config").code, 2);
}

TEST_F(PruneCommand, TheOrderOfTheFilePlaysNoPartForPcm) {
  make_corrupted();
  std::istringstream lines(read_text(folder / "bad.g2o"));
  std::string vertices_and_odometry;
  std::string loops;  // the last one first
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    std::string tag;
    long from = 0;
    long to = 0;
    fields >> tag >> from >> to;
    if (tag == "EDGE_SE2" && std::abs(from - to) != 1) {
      loops.insert(0, line + "\n");
    } else {
      vertices_and_odometry += line + "\n";
    }
  }
  isotherm_test::write_text(folder / "turned.g2o", vertices_and_odometry + loops);
  const auto kept = [&](const std::string& name) {
    std::istringstream all(run_ok("prune " + name + " --method pcm -q -o -"));
    std::multiset<std::string> sorted;
    for (std::string line; std::getline(all, line);) sorted.insert(line);
    return sorted;
  };
  EXPECT_EQ(kept("bad.g2o"), kept("turned.g2o"));
}

TEST_F(PruneCommand, SameBytesForAnyNumberOfThreads) {
  make_corrupted();
  for (const std::string method : {"consensus", "heat"}) {
    const auto prune = "prune bad.g2o --method " + method;
    run_ok(prune + " --threads 1 -o one.g2o --verdicts one.csv");
    run_ok(prune + " --threads 2 -o two.g2o --verdicts two.csv");
    EXPECT_EQ(read_text(folder / "one.g2o"), read_text(folder / "two.g2o"));
    EXPECT_EQ(read_text(folder / "one.csv"), read_text(folder / "two.csv"));
  }
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
