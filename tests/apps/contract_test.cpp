// Exit codes, streams and files as the command promises them.
#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run_command.hpp"

namespace {

using isotherm_test::CommandTest;
using isotherm_test::write_text;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kVerbs[] = {
    "info",     "simulate city", "corrupt",          "prune",        "label",          "eval loops",
    "edges",    "embed",         "simulate network", "localize",     "eval positions", "optimize",
    "eval ate", "convert",       "densify",          "eval evidence"};

class Contract : public CommandTest {
 protected:
  // How many files the test's folder holds beside the captured streams.
  std::size_t files() const {
    const auto all = std::filesystem::directory_iterator(folder);
    return static_cast<std::size_t>(std::count_if(begin(all), end(all), [](const auto& entry) {
      return entry.path().filename().string().front() != '.';
    }));
  }
};

TEST_F(Contract, EveryVerbHasHelpThatFitsATerminal) {
  for (const std::string verb : kVerbs) {
    const auto result = run(verb + " --help");
    EXPECT_EQ(result.code, 0) << verb;
    EXPECT_THAT(result.out, HasSubstr("Usage"));
    EXPECT_THAT(result.out, HasSubstr("--json"));
    std::istringstream lines(result.out);
    for (std::string line; std::getline(lines, line);) {
      EXPECT_LE(line.size(), 80u) << verb << ": " << line;
      EXPECT_EQ(line.find('_'), std::string::npos) << "kebab-case only: " << line;
    }
  }
}

TEST_F(Contract, UsageErrorsExitWith2) {
  EXPECT_EQ(run("").code, 2);
  EXPECT_EQ(run("fly").code, 2);
  EXPECT_EQ(run("prune").code, 2);
  EXPECT_EQ(run("simulate city -o a.g2o --poses none").code, 2);
  EXPECT_EQ(run("simulate city -o a.g2o --poses 0").code, 2);
  EXPECT_EQ(run("prune a.g2o --method magic").code, 2);
  EXPECT_EQ(run("info a.g2o --threads -1").code, 2);
  EXPECT_EQ(files(), 0u);
}

TEST_F(Contract, BadFilesExitWith3NamingFileLineAndToken) {
  const auto unreadable = run("prune nowhere.g2o -o out.g2o --verdicts out.csv");
  EXPECT_EQ(unreadable.code, 3);
  EXPECT_THAT(unreadable.err, HasSubstr("nowhere.g2o"));

  const struct {
    const char* text;
    const char* place;
    const char* token;
  } cases[] = {
      {"", "bad.g2o", "empty"},
      {"EDGE_SE2 0 1 1 0 0 1 0 0 1 0\n", "bad.g2o:1", "end of the line"},
      {"VERTEX_SE2 0 0 0 0\nEDGE_SE2 0 1 nan 0 0 1 0 0 1 0 1\n", "bad.g2o:2:14", "'nan'"},
      {"VERTEX_SE2 -3 0 0 0\n", "bad.g2o:1:12", "'-3'"},
      {"VERTEX_SE2 1.5 0 0 0\n", "bad.g2o:1:12", "'1.5'"},
  };
  for (const auto& bad : cases) {
    write_text(folder / "bad.g2o", bad.text);
    const auto result = run("prune bad.g2o -o out.g2o --verdicts out.csv --json out.json");
    EXPECT_EQ(result.code, 3) << bad.text;
    EXPECT_THAT(result.err, HasSubstr(bad.place));
    EXPECT_THAT(result.err, HasSubstr(bad.token));
  }
  EXPECT_EQ(files(), 1u) << "no output is left behind";
}

TEST_F(Contract, InvalidInformationIsRepairedWithAWarningUnlessStrict) {
  write_text(folder / "a.g2o",
             "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n"
             "EDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\n"
             "EDGE_SE2 0 2 2 0 0 1 0 0 -1 0 1\n");
  const auto lenient = run("prune a.g2o --method chi2 -o out.g2o");
  EXPECT_EQ(lenient.code, 0) << lenient.err;
  EXPECT_THAT(lenient.err, HasSubstr("a.g2o:3"));
  EXPECT_THAT(lenient.err, HasSubstr("warning"));
  std::filesystem::remove(folder / "out.g2o");
  const auto strict = run("prune a.g2o --method chi2 -o out.g2o --strict");
  EXPECT_EQ(strict.code, 3);
  EXPECT_THAT(strict.err, HasSubstr("a.g2o:3"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out.g2o"));
}

TEST_F(Contract, StdoutCarriesDataOnly) {
  const auto graph = run_ok("simulate city --poses 20 --loops 3 -o -");
  EXPECT_THAT(graph, testing::StartsWith("VERTEX_SE2 0 0 0 0\n"));
  EXPECT_THAT(graph, Not(HasSubstr("city:")));
  EXPECT_THAT(run("simulate city --poses 20 -o a.g2o -q").err, testing::IsEmpty());
}

TEST_F(Contract, ReadsStandardInput) {
  run_ok("simulate city --poses 30 --loops 3 -o a.g2o");
  EXPECT_EQ(run_ok("info - --json - < a.g2o"), run_ok("info a.g2o --json -"));
}

TEST_F(Contract, ConfigurationGivesWayToFlags) {
  write_text(folder / "c.json",
             R"({"method": "heat", "tolerance": 0.2, "konst": [2.5], "threshold": "gap"})");
  const auto dumped = run_ok("prune x.g2o --config c.json --tolerance 0.3 --dump-config");
  EXPECT_THAT(dumped, HasSubstr("\"method\": \"heat\""));
  EXPECT_THAT(dumped, HasSubstr("\"tolerance\": 0.3"));
  EXPECT_THAT(dumped, HasSubstr("2.5"));
  EXPECT_THAT(dumped, HasSubstr("\"threshold\": \"gap\""));
  write_text(folder / "d.json", dumped);
  EXPECT_EQ(run_ok("prune x.g2o --config d.json --dump-config"), dumped);

  write_text(folder / "bad.json", R"({"sinificance": 0.2})");
  const auto unknown = run("prune x.g2o --config bad.json --dump-config");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("sinificance"));
  write_text(folder / "bad.json", "{");
  EXPECT_EQ(run("prune x.g2o --config bad.json --dump-config").code, 3);
  EXPECT_EQ(run("prune x.g2o --config nowhere.json --dump-config").code, 3);
}

}  // namespace
