// 'follow': verdicts as a graph comes in, that end where those of 'prune' do.
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "run_command.hpp"

namespace {

using isotherm_test::CommandTest;
using isotherm_test::read_text;
using isotherm_test::write_text;
using testing::HasSubstr;
using Json = nlohmann::json;

class Follow : public CommandTest {
 protected:
  void SetUp() override {
    run_ok("simulate city --poses 80 --loops 30 -o clean.g2o -q");
    run_ok("corrupt clean.g2o -o bad.g2o --ratio 0.5 --labels l.csv -q");
    run_ok("convert bad.g2o --in-time-order -o in.g2o -q");
    run_ok("prune in.g2o --verdicts batch.csv -q");
  }

  static std::vector<Json> events_of(const std::string& text) {
    std::vector<Json> events;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) events.push_back(Json::parse(line));
    return events;
  }
};

TEST_F(Follow, EndsWithTheVerdictsOfPrune) {
  const auto events =
      events_of(run_ok("follow in.g2o --verdicts v.csv -o out.g2o --json s.json -q"));
  EXPECT_EQ(read_text(folder / "v.csv"), read_text(folder / "batch.csv"));
  ASSERT_GT(events.size(), 45U);
  EXPECT_EQ(events.back()["event"], "end");
  EXPECT_EQ(events.back()["loops"], 45);
  EXPECT_EQ(events.front()["event"], "verdict");
  for (const char* key :
       {"at", "edge", "from", "to", "verdict", "probability", "stage", "reason"}) {
    EXPECT_TRUE(events.front().contains(key)) << key;
  }
  EXPECT_EQ(Json::parse(read_text(folder / "s.json"))["schema"], "isotherm.follow/1");
  run_ok("info out.g2o");
}

TEST_F(Follow, ReadsAPipe) {
  run_ok("follow - --verdicts v.csv -q < in.g2o");
  EXPECT_EQ(read_text(folder / "v.csv"), read_text(folder / "batch.csv"));
}

TEST_F(Follow, GoesOnAfterItWasKilled) {
  const std::string whole = read_text(folder / "in.g2o");
  for (const double share : {0.4, 0.7, 0.95}) {
    const auto cut =
        whole.find('\n', static_cast<std::size_t>(share * static_cast<double>(whole.size())));
    write_text(folder / "start.g2o", whole.substr(0, cut + 1));
    run_ok("follow start.g2o --state state -q");
    std::ofstream(folder / "state", std::ios::app) << "EDGE 0 12 ";  // as it was being written
    run_ok("follow in.g2o --state state --verdicts v.csv -q");
    EXPECT_EQ(read_text(folder / "v.csv"), read_text(folder / "batch.csv"));
    std::filesystem::remove(folder / "state");
  }
}

TEST_F(Follow, WritesThePresentMap) {
  run_ok("follow in.g2o --map now.g2o --every 10 -q");
  run_ok("info now.g2o");
  EXPECT_EQ(run("follow in.g2o --map now.g2o").code, 2);
  EXPECT_EQ(run("follow in.g2o --every 3").code, 2);
}

TEST_F(Follow, IsJudgedThroughTime) {
  run_ok("simulate city --poses 80 --loops 30 -o clean.g2o --ground-truth truth.g2o -q");
  run_ok("convert bad.g2o --in-time-order -o in.g2o --known-labels l.csv --labels in.csv -q");
  run_ok(
      "follow in.g2o --every 10 --ground-truth truth.g2o --events e.jsonl --times t.csv "
      "--verdicts v.csv --json s.json -q");
  const std::string text = run_ok("eval online e.jsonl in.csv --json o.json --steps steps.csv");
  EXPECT_THAT(text, HasSubstr("iATE"));
  const auto result = Json::parse(read_text(folder / "o.json"));
  EXPECT_EQ(result["schema"], "isotherm.eval.online/1");
  EXPECT_EQ(
      result["right"].get<int>() + result["wrong"].get<int>() + result["ambiguous"].get<int>(), 45);
  EXPECT_GE(result["mean_precision"], 0.5);
  const auto decided = Json::parse(run_ok("eval online e.jsonl in.csv --even-odds --json - -q"));
  EXPECT_EQ(decided["ambiguous"], 0);
  EXPECT_GE(decided["right"].get<int>(), result["right"].get<int>());
  const auto whole = Json::parse(run_ok("eval loops v.csv in.csv --json - -q"));
  EXPECT_EQ(result["ambiguous"], whole["ambiguous"]);
  EXPECT_GE(result["right"].get<int>(), whole["tp"].get<int>());
  const auto summary = Json::parse(read_text(folder / "s.json"));
  EXPECT_NEAR(summary["iate_m"].get<double>(), result["iate_m"].get<double>(), 1e-12);
  EXPECT_THAT(read_text(folder / "steps.csv"),
              testing::StartsWith("at,poses,kept_true,kept_false,missed,precision,recall,ate\n"));
  EXPECT_THAT(read_text(folder / "t.csv"), testing::StartsWith("edge,poses,ms,cpu_ms\n0,0,"));
}

TEST_F(Follow, SaysWhatAnEventLogLacks) {
  write_text(folder / "e.jsonl", "{\"event\": \"end\", \"edges\": 3}\n{\"event\": \"verdict\"}\n");
  auto result = run("eval online e.jsonl l.csv");
  EXPECT_EQ(result.code, 3);
  EXPECT_THAT(result.err, HasSubstr("e.jsonl:2:"));
  EXPECT_THAT(result.err, HasSubstr("without 'edge'"));
  EXPECT_EQ(run("follow in.g2o --ground-truth clean.g2o").code, 2);
  EXPECT_EQ(run("follow - --every 5 --ground-truth clean.g2o < in.g2o").code, 2);
  EXPECT_EQ(run("convert bad.g2o -o c.g2o --known-labels l.csv").code, 2);
}

TEST_F(Follow, ReplaysJrl) {
  const auto between = [](int from, int to, double x) {
    return R"({"type": "BetweenFactorPose2", "key1": )" + std::to_string(from) + R"(, "key2": )" +
           std::to_string(to) + R"(, "measurement": {"x": )" + std::to_string(x) +
           R"(, "y": 0, "theta": 0}, "covariance": [0.01, 0, 0, 0, 0.01, 0, 0, 0, 0.01]})";
  };
  // There and back on a line, with six loops between the ways and one that is false.
  std::string entries;
  for (int k = 0; k < 20; ++k) {
    entries += k > 0 ? ",\n" : "";
    entries += "{\"stamp\": " + std::to_string(k) + ", \"measurements\": [" +
               between(k, k + 1, k < 10 ? 1.0 : -1.0);
    if (k >= 13) entries += ", " + between(k + 1, 20 - k - 1, k == 19 ? 30.0 : 0.0);
    entries += "]}";
  }
  write_text(folder / "a.jrl", "{\"measurements\": {\"a\": [" + entries +
                                   "]}, \"outlier_factors\": {\"a\": [[19, 1]]}}");
  run_ok("prune a.jrl --verdicts b.csv -q");
  run_ok("follow a.jrl --verdicts v.csv --events e.jsonl -q");
  EXPECT_EQ(read_text(folder / "v.csv"), read_text(folder / "b.csv"));
  run_ok("convert a.jrl -o a.g2o --labels l.csv -q");
  const auto result = Json::parse(run_ok("eval online e.jsonl l.csv --json - -q"));
  EXPECT_EQ(result["right"], 7);
  EXPECT_EQ(Json::parse(run_ok("info a.jrl --json - -q"))["format"], "jrl");
  EXPECT_EQ(run("convert a.jrl -o a.g2o --truth t.g2o").code, 2);
}

TEST_F(Follow, SaysWhereTheInputIsWrong) {
  write_text(folder / "a.g2o",
             "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n\n# note\nEDGE_SE2 1 2 1 0 x 1 0 0 1 0 1\n");
  auto result = run("follow a.g2o");
  EXPECT_EQ(result.code, 3);
  EXPECT_THAT(result.err, HasSubstr("a.g2o:4:"));
  write_text(folder / "b.g2o", "EDGE_SE2 0 1 1 0 0 -1 0 0 1 0 1\n");
  EXPECT_THAT(run("follow b.g2o").err, HasSubstr("b.g2o:1:"));
  write_text(folder / "c.g2o", "# nothing\n");
  EXPECT_EQ(run("follow c.g2o").code, 3);
  EXPECT_EQ(run("follow nowhere.g2o").code, 3);
  EXPECT_EQ(run("follow in.g2o --effort -1").code, 2);
}

}  // namespace
