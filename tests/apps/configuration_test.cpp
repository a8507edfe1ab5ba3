// Options from files and flags: their types, their ranges, and documents that are none.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run_command.hpp"

namespace {

using isotherm_test::CommandTest;
using isotherm_test::write_text;
using testing::HasSubstr;
using testing::StartsWith;

class Configuration : public CommandTest {
 protected:
  isotherm_test::CommandResult with_config(const std::string& text) const {
    write_text(folder / "c.json", text);
    return run("prune x.g2o --config c.json --dump-config");
  }
};

TEST_F(Configuration, TakesNumbersAsTheyStand) {
  EXPECT_EQ(with_config(R"({"window": 7, "significance": 0.25, "calibrate": false})").code, 0);
  // What another method has may be out of range for a third.
  EXPECT_EQ(with_config(R"({"method": "heat", "significance": 0.7})").code, 0);
  EXPECT_THAT(run("prune x --method heat --significance 0.7").err,
              HasSubstr("is an option of consensus, chi2, not of method heat"));
  const struct {
    const char* text;
    const char* problem;
  } cases[] = {
      {R"({"window": 4294967297})", "window: "},
      {R"({"window": 18446744073709551617})", "window: "},
      {R"({"window": 20.9})", "window: has the wrong type in the configuration: 20.9"},
      {R"({"window": 0})", "window: must be in [1, "},
      {R"({"window": true})", "window: has the wrong type"},
      {R"({"window": "7"})", "window: has the wrong type"},
      {R"({"calibrate": 1})", "calibrate: has the wrong type"},
      {R"({"significance": 0.5})", "significance: must be in (0, 0.5)"},
      {R"({"scales": [1, "2"]})", "scales: has the wrong type"},
      {R"({"method": "heat", "konst": []})", "konst: must not be empty"},
      {R"({"method": 3})", "method: has the wrong type"},
  };
  for (const auto& wrong : cases) {
    const auto result = with_config(wrong.text);
    EXPECT_EQ(result.code, 2) << wrong.text;
    EXPECT_THAT(result.err, HasSubstr(wrong.problem)) << wrong.text;
  }
}

TEST_F(Configuration, NamesThePlaceWhereAFileIsNoJson) {
  EXPECT_EQ(with_config("{\n \"window\": x}").err,
            "isotherm: c.json:2:12: is not valid JSON (got '\"window\": x')\n");
  EXPECT_THAT(with_config(R"({"significance": 1e999})").err,
              HasSubstr("c.json:1:22: is no finite number (got '1e999')"));
  EXPECT_EQ(with_config("[1]").err, "isotherm: c.json: must hold a JSON object\n");
  const auto folder_as_file = run("prune x.g2o --config . --dump-config");
  EXPECT_EQ(folder_as_file.code, 3);
  EXPECT_EQ(folder_as_file.err, "isotherm: .: is a directory\n");
}

TEST_F(Configuration, DeepDocumentsAreRefused) {
  for (const std::string bracket : {"[", "{\"a\":"}) {
    std::string text;
    for (int level = 0; level < 100'000; ++level) text += bracket;
    EXPECT_THAT(with_config(text).err, HasSubstr("nested deeper than 100 levels"));
    EXPECT_EQ(with_config(text).code, 3);
    const auto report = run("report c.json -o page.html");
    EXPECT_EQ(report.code, 3);
    EXPECT_THAT(report.err, HasSubstr("nested deeper than 100 levels"));
  }
}

TEST_F(Configuration, IsReadByEveryVerb) {
  write_text(folder / "in", "0,1,1\n");
  write_text(folder / "c.json", R"({"window": 7})");
  for (const std::string verb : {"info in", "convert in -o out.mtx", "embed in -o -", "edges in",
                                 "eval loops in in", "report in -o x.html"}) {
    const auto result = run(verb + " --config c.json");
    EXPECT_EQ(result.code, 2) << verb;
    EXPECT_THAT(result.err, HasSubstr("window: is not an option of this command")) << verb;
    EXPECT_THAT(run_ok(verb + " --dump-config"), StartsWith("{"));
  }
}

TEST_F(Configuration, EveryNumberHasARangeThatHelpStates) {
  const char* const kVerbs[] = {"prune --method heat",
                                "prune --method lap-line",
                                "prune --method rrr",
                                "prune --method pcm",
                                "prune --method gnc",
                                "prune --method chi2",
                                "prune",
                                "optimize",
                                "label",
                                "corrupt",
                                "edges",
                                "embed",
                                "localize",
                                "simulate city",
                                "simulate network",
                                "simulate sphere",
                                "eval rpe",
                                "follow"};
  for (const std::string verb : kVerbs) {
    std::istringstream lines(run_ok(verb + " --help"));
    std::string entry;
    const auto check = [&] {
      const bool number =
          entry.find("INT") != std::string::npos || entry.find(" FLOAT") != std::string::npos;
      const bool named = entry.find(":{") != std::string::npos;
      if (!number || named) return;
      EXPECT_THAT(entry, testing::ContainsRegex("in *[[(][-0-9.e+]+, *[-0-9.e+^]+[])]")) << verb;
    };
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("  -")) {
        check();
        entry.clear();
      }
      const auto first = line.find_first_not_of(' ');
      entry += first == std::string::npos ? "" : line.substr(first - (first > 0 ? 1 : 0));
    }
    check();
  }
}

TEST_F(Configuration, RangesAreEnforced) {
  const char* const kWrong[] = {
      "prune x --method lap-line --curve-step 1e-9",
      "prune x --method lap-line --curve-step 1e-3",
      "prune x --method lap-line --curve-windows 60,nan",
      "prune x --threads 10000000",
      "prune x --threads 4294967297",
      "prune x --method heat --tolerance 0",
      "prune x --method rrr --rrr-iterations 99999999999",
      "optimize x --cost-tolerance inf",
      "simulate city -o out --poses 1000000000000",
      "simulate city -o out --odometry-sigma 1e-300",
      "simulate network -o out --anchors 2000 --nodes 100",
      "edges x --radius -1",
      "edges x --neighbours 2.5",
      "embed x -o out --scale -1",
      "label x --ground-truth x -o out --max-gap -1",
      "eval ate x x --max-gap nan",
      "corrupt x -o out --count 5 --group-size -1",
      "prune x --seed -1",
      "follow x --map out --every -1",
  };
  for (const std::string wrong : kWrong) {
    const auto result = run(wrong);
    EXPECT_EQ(result.code, 2) << wrong << "\n" << result.err;
    EXPECT_THAT(result.err, testing::Not(testing::IsEmpty()));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST_F(Configuration, ManyThreadsChangeAndSayNothing) {
  run_ok("simulate city --poses 200 --loops 30 -o in.g2o -q");
  const auto one = run("prune in.g2o --method heat --verdicts - -q --threads 1");
  const auto many = run("prune in.g2o --method heat --verdicts - -q --threads 1024");
  EXPECT_EQ(many.code, 0);
  EXPECT_EQ(many.out, one.out);
  EXPECT_EQ(many.err, "");
}

}  // namespace
