// Input that is merely hard is repaired with a warning that names it, refused with --strict, and
// never a failure of the program.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run_command.hpp"

namespace {

using isotherm_test::CommandTest;
using isotherm_test::write_text;
using testing::HasSubstr;

class HardInput : public CommandTest {
 protected:
  // A square of four poses, driven twice, with loops; `information` is that of one odometry
  // edge on line 3.
  void write_graph(const std::string& information) const {
    constexpr int kPoses = 8;
    std::string text;
    for (int v = 0; v + 1 < kPoses; ++v) {
      text += "EDGE_SE2 " + std::to_string(v) + " " + std::to_string(v + 1) +
              " 1 0 1.5707963267948966 " + (v == 2 ? information : "400 0 0 400 0 10000") + "\n";
    }
    for (int v = 0; v + 4 < kPoses; ++v) {
      text += "EDGE_SE2 " + std::to_string(v) + " " + std::to_string(v + 4) +
              " 0 0 0 400 0 0 400 0 10000\n";
    }
    write_text(folder / "in.g2o", text);
  }
};

TEST_F(HardInput, OdometryThatIsNearlySingular) {
  const char* const kMatrices[] = {
      "1e7 0 0 1e-7 0 1e-7",       // condition 1e14
      "1e9 0 0 1e-9 0 1e-9",       // 1e18
      "1 2 3 4 6 9",               // rank 1
      "400 0 0 0 0 0",             // rank 1, on the diagonal
      "1 1.000000000001 0 1 0 1",  // indefinite by 1e-12
      "1e99 0 0 1e99 0 1e99",      // far beyond the others
      "1e-99 0 0 1e-99 0 1e-99",   // far below
  };
  for (const std::string matrix : kMatrices) {
    write_graph(matrix);
    for (const std::string method : {"consensus", "heat", "chi2", "rrr", "pcm", "gnc"}) {
      const auto result = run("prune in.g2o --method " + method);
      EXPECT_EQ(result.code, 0) << method << ": " << matrix << "\n" << result.err;
      EXPECT_THAT(result.err, HasSubstr("warning: odometry edge 2, from vertex 2 to 3: "))
          << matrix;
      const auto strict = run("prune in.g2o --strict --method " + method);
      EXPECT_EQ(strict.code, 3) << matrix;
      EXPECT_THAT(strict.err, HasSubstr("in.g2o:3: odometry edge 2, from vertex 2 to 3")) << matrix;
    }
  }
  write_graph("0 0 0 0 0 0");
  EXPECT_THAT(run("prune in.g2o").err, testing::Not(HasSubstr("singular")));
}

TEST_F(HardInput, AnOptimisationThatDiverges) {
  for (const std::string far : {"1e200", "1.7e308"}) {
    write_text(folder / "in.g2o", "EDGE_SE2 0 1 " + far + " 0 0 1 0 0 1 0 1\nEDGE_SE2 1 2 " + far +
                                      " 0 0 1 0 0 1 0 1\nEDGE_SE2 0 2 -" + far +
                                      " 0 0 1 0 0 1 0 1\n");
    for (const std::string outputs : {"", " -o out.g2o", " -o out.tum", " --json out.json"}) {
      const auto result = run("optimize in.g2o" + outputs);
      EXPECT_EQ(result.code, 4) << far << outputs;
      EXPECT_THAT(result.err, HasSubstr("diverged: cost not finite")) << far << outputs;
    }
  }
}

TEST_F(HardInput, InformationBeyondAllMeasureIsLocated) {
  write_graph("1e300 0 0 1e300 0 1e300");
  const auto result = run("prune in.g2o --verdicts -");
  EXPECT_EQ(result.code, 3);
  EXPECT_THAT(result.err, HasSubstr("in.g2o:3:"));
  EXPECT_THAT(result.err, HasSubstr("1e300"));
}

TEST_F(HardInput, ARowThatIsThereTwiceIsLocated) {
  write_text(folder / "verdicts.csv",
             "edge,from,to,verdict,score,threshold,stage\n1,0,5,keep,0,1,a\n1,0,5,prune,2,1,a\n");
  write_text(folder / "labels.csv", "edge,from,to,label\n1,0,5,correct\n");
  const auto result = run("eval loops verdicts.csv labels.csv");
  EXPECT_EQ(result.code, 3);
  EXPECT_THAT(result.err, HasSubstr("verdicts.csv:3:1: edge occurs twice (got '1')"));
}

TEST_F(HardInput, ATimeThatIsThereTwiceCountsOnce) {
  const auto row = [](int time) {
    return std::to_string(time) + " " + std::to_string(time * time) + " 0 0 0 0 0 1\n";
  };
  write_text(folder / "truth.tum", row(0) + row(1) + row(2) + row(3));
  write_text(folder / "estimate.tum", row(0) + row(1) + row(2) + row(2) + row(3));
  const auto result = run("eval ate estimate.tum truth.tum --align none");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("max 0.0000 m  (4 pairs)"));
}

}  // namespace
