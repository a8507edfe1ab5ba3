// From a graph with loops to poses, and from poses to errors.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "run_command.hpp"

namespace {

using isotherm_test::CommandTest;
using isotherm_test::read_text;
using isotherm_test::write_text;
using testing::HasSubstr;

class OptimizeCommand : public CommandTest {
 protected:
  void make_city() const {
    run_ok("simulate city --poses 400 --loops 150 --seed 2 -o clean.g2o --ground-truth gt.g2o");
  }
};

TEST_F(OptimizeCommand, BringsTheTrajectoryToTheTruth) {
  make_city();
  for (const std::string start : {"odometry", "spanning-tree", "chordal", "file"}) {
    run_ok("optimize clean.g2o -o out.g2o --json result.json --initialization " + start);
    const auto json = read_text(folder / "result.json");
    for (const char* key : {"isotherm.optimize/1", "\"status\": \"converged\"", "\"iterations\"",
                            "\"final_cost\"", "\"components\": 1", "\"options\""}) {
      EXPECT_THAT(json, HasSubstr(key));
    }
    // Odometry alone is metres away.
    const auto ate = run_ok("eval ate out.g2o gt.g2o");
    EXPECT_THAT(ate, testing::ContainsRegex("RMSE 0\\.[0-2]")) << ate;
  }
}

TEST_F(OptimizeCommand, EndsAtTheOptimumByDefault) {
  run_ok("simulate city --poses 3000 --loops 60 --drift 50 --seed 2 -o city.g2o");
  run_ok("simulate sphere --poses 600 --loops 40 --seed 2 -o sphere.g2o");
  for (const std::string graph : {"city.g2o", "sphere.g2o"}) {
    const auto cost = [&](const std::string& flags) {
      const auto json = run_ok("optimize " + graph + " -q --json - " + flags);
      return nlohmann::json::parse(json)["final_cost"].get<double>();
    };
    EXPECT_LE(cost(""), (1.0 + 2e-6) * cost("--cost-tolerance 1e-13")) << graph;
  }
}

TEST_F(OptimizeCommand, KernelsAndAlgorithms) {
  make_city();
  for (const std::string kernel : {"huber", "cauchy", "dcs", "sc", "gnc", "gnc-gm"}) {
    run_ok("optimize clean.g2o -o out.g2o --kernel " + kernel +
           " --kernel-width 5 --algorithm gauss-newton");
  }
  EXPECT_EQ(run("optimize clean.g2o --kernel tukey").code, 2);
  EXPECT_EQ(run("optimize clean.g2o --kernel-width -1").code, 2);
}

TEST_F(OptimizeCommand, KernelsSpareEdgesThatAreTrusted) {
  write_text(folder / "bend.g2o",
             "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nVERTEX_SE2 2 2 0 0\n"
             "EDGE_SE2 0 1 1 0 0 100 0 0 100 0 100\nEDGE_SE2 1 2 1 0 0 100 0 0 100 0 100\n"
             "EDGE_SE2 0 2 0.5 0 0 100 0 0 100 0 100\n");
  write_text(folder / "all.csv", "edge\n0\n1\n2\n");
  run_ok("optimize bend.g2o --kernel cauchy -o doubted.g2o");
  EXPECT_THAT(read_text(folder / "doubted.g2o"), HasSubstr("VERTEX_SE2 2 1.9"));
  run_ok("optimize bend.g2o --kernel cauchy --trusted all.csv --json trusted.json");
  run_ok("optimize bend.g2o --json plain.json");
  const auto cost = [this](const char* name) {
    return nlohmann::json::parse(read_text(folder / name))["final_cost"].get<double>();
  };
  EXPECT_DOUBLE_EQ(cost("trusted.json"), cost("plain.json"));
  EXPECT_EQ(run("optimize bend.g2o --trusted nowhere.csv").code, 3);
}

TEST_F(OptimizeCommand, SaysWhenItDidNotConverge) {
  make_city();
  const auto result = run("optimize clean.g2o -o start.g2o --max-iterations 0 --json result.json");
  EXPECT_EQ(result.code, 4);
  EXPECT_THAT(read_text(folder / "result.json"), HasSubstr("iteration-limit"));
  EXPECT_TRUE(std::filesystem::exists(folder / "start.g2o"));
}

TEST_F(OptimizeCommand, WritesTrajectories) {
  make_city();
  run_ok("optimize clean.g2o -o a.tum");
  run_ok("optimize clean.g2o -o b.tum --algorithm gauss-newton --initialization odometry");
  EXPECT_THAT(run_ok("eval ate a.tum b.tum --align none"), HasSubstr("max 0.0000"));
}

TEST_F(OptimizeCommand, DegenerateGraphs) {
  write_text(folder / "one.g2o", "VERTEX_SE2 7 1 2 0.5\n");
  run_ok("optimize one.g2o -o out.g2o");
  EXPECT_THAT(read_text(folder / "out.g2o"), HasSubstr("VERTEX_SE2 7 1 2 0.5"));
  write_text(folder / "self.g2o",
             "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\n"
             "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 1 1 1 0 0 1 0 0 1 0 1\n");
  run_ok("optimize self.g2o -o out.g2o --json result.json");
  EXPECT_THAT(read_text(folder / "result.json"), HasSubstr("\"final_cost\": 1.0"));
  write_text(folder / "apart.g2o",
             "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nVERTEX_SE2 5 3 3 1\nVERTEX_SE2 6 4 3 1\n"
             "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 5 6 1 0 0 1 0 0 1 0 1\n");
  const auto apart = run("optimize apart.g2o -o out.g2o --json result.json");
  EXPECT_EQ(apart.code, 0);
  EXPECT_THAT(apart.err, HasSubstr("2 connected components"));
}

TEST_F(OptimizeCommand, TrajectoryErrors) {
  write_text(folder / "a.tum", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n3 2 1 0 0 0 0 1\n");
  write_text(folder / "b.tum", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n3.001 2 2 0 0 0 0 1\n");
  const auto ate = run_ok("eval ate a.tum b.tum --align none --json -");
  for (const char* key :
       {"isotherm.eval.ate/1", "\"align\": \"none\"", "\"pairs\": 3", "\"max\": 1.0",
        "\"median\": 0.0", "\"mean\": 0.333", "\"rmse\": 0.577"}) {
    EXPECT_THAT(ate, HasSubstr(key));
  }
  const auto rpe = run_ok("eval rpe a.tum b.tum --json -");
  for (const char* key : {"isotherm.eval.rpe/1", "\"pairs\": 2", "\"mean\": 0.5", "\"rotation\""}) {
    EXPECT_THAT(rpe, HasSubstr(key));
  }
  EXPECT_THAT(run_ok("eval ate a.tum b.tum --align first"),
              HasSubstr("the mean is the ATE of Datta et al."));
  EXPECT_EQ(run("eval ate a.tum b.tum --align sim").code, 2);
  EXPECT_EQ(run("eval rpe a.tum b.tum --delta 0").code, 2);
  EXPECT_EQ(run("eval ate a.tum missing.tum").code, 3);
}

}  // namespace
