// How poses meet their true ones: by id, time or row, and with which axes.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "isotherm_test/data.hpp"
#include "run_command.hpp"

namespace {

using isotherm_test::read_text;
using isotherm_test::write_text;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

class TruthMatch : public isotherm_test::CommandTest {
 protected:
  TruthMatch() {
    run_ok("simulate city --poses 300 --loops 60 --seed 2 -q -o map.g2o --ground-truth truth.g2o");
  }

  // Lines of a g2o truth whose ids are `step` apart, from 0.
  std::string thinned(int step) const {
    std::istringstream lines(read_text(folder / "truth.g2o"));
    std::string all;
    int row = 0;
    for (std::string line; std::getline(lines, line); ++row) {
      if (row % step != 0) continue;
      const auto id = line.find(' ', line.find(' ') + 1);
      all += "VERTEX_SE2 " + std::to_string(row / step) + line.substr(id) + "\n";
    }
    return all;
  }

  double rmse(const std::string& arguments) const {
    return Json::parse(run_ok("eval " + arguments + " -q --json -"))["rmse"];
  }
};

TEST_F(TruthMatch, SaysHowManyMatch) {
  EXPECT_THAT(run("label map.g2o --ground-truth truth.g2o -o l.csv").err,
              HasSubstr("ground truth: 300 of 300 poses have one\n"));
  EXPECT_THAT(run("eval ate map.g2o truth.g2o").err,
              HasSubstr("ground truth: 300 of 300 poses have one\n"));
}

TEST_F(TruthMatch, OtherIdsAreNoticedByHowPosesMove) {
  write_text(folder / "other.g2o", thinned(2) + "VERTEX_SE2 900 0 0 0\n");
  const auto said = run("label map.g2o --ground-truth other.g2o -o l.csv").err;
  EXPECT_THAT(said, HasSubstr("ground truth: 150 of 300"));
  EXPECT_THAT(said, HasSubstr("the true poses do not move as odometry does"));
}

TEST_F(TruthMatch, FewerThanHalfAreRefusedUnlessTold) {
  write_text(folder / "few.g2o", thinned(3));
  for (const std::string verb : {"label map.g2o --ground-truth few.g2o -o l.csv",
                                 "eval ate map.g2o few.g2o", "eval rpe map.g2o few.g2o"}) {
    const auto refused = run(verb);
    EXPECT_EQ(refused.code, 2) << verb;
    EXPECT_THAT(refused.err, HasSubstr("few.g2o has a pose for 100 of 300 vertices only"));
    EXPECT_EQ(run(verb + " --partial").code, 0) << verb;
  }
}

TEST_F(TruthMatch, TimesAreNotInvented) {
  const auto written = run("convert truth.g2o -o truth.tum");
  EXPECT_THAT(written.err, HasSubstr("no times, which tum needs: pose k is given the time k"));
  EXPECT_THAT(run("optimize map.g2o -o map.tum").err, HasSubstr("pose k is given the time k"));
  run_ok("convert map.g2o -q -o map.kitti");
  EXPECT_THAT(run("convert map.g2o -o map.kitti").err, Not(HasSubstr("times")));
  const auto lacking = run("eval ate map.kitti truth.tum");
  EXPECT_EQ(lacking.code, 2);
  EXPECT_THAT(lacking.err, HasSubstr("--timestamps: FILE is needed: truth.tum has times by which "
                                     "poses are matched, map.kitti has none"));
  std::string times;
  for (int k = 0; k < 300; ++k) times += std::to_string(k) + "\n";
  write_text(folder / "times.txt", times);
  EXPECT_NEAR(rmse("ate map.kitti truth.tum --timestamps times.txt"), rmse("ate map.g2o truth.g2o"),
              1e-9);
  const auto none = run("eval ate map.tum truth.kitti");
  EXPECT_EQ(none.code, 3);
  run_ok("convert truth.g2o -q -o truth.kitti");
  EXPECT_THAT(run("eval ate map.tum truth.kitti").err, HasSubstr("truth.kitti has no times"));
}

TEST_F(TruthMatch, TimesOfAnotherClockAreRefused) {
  run_ok("convert map.g2o -q -o map.tum");
  std::string late;
  for (int k = 0; k < 300; ++k) late += std::to_string(1000 + k) + " 0 0 0 0 0 0 1\n";
  write_text(folder / "late.tum", late);
  const auto refused = run("eval ate map.tum late.tum");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("only 0 of 300 estimated poses match"));
}

TEST_F(TruthMatch, AxesAreConvertedAndMissedOnesNoticed) {
  run_ok("simulate sphere --poses 400 --seed 1 -q -o ball.g2o --ground-truth ball_truth.g2o");
  run_ok("convert ball_truth.g2o -q -o vehicle.kitti");
  run_ok("convert vehicle.kitti --axes vehicle-to-camera -q -o camera.kitti");
  run_ok("convert camera.kitti --axes camera-to-vehicle -q -o back.kitti");
  run_ok("convert ball.g2o -q -o ball.kitti");
  const double right = rmse("rpe ball.kitti vehicle.kitti");
  EXPECT_NEAR(rmse("rpe ball.kitti back.kitti"), right, 1e-9);
  EXPECT_NEAR(rmse("rpe ball.kitti camera.kitti --axes camera"), right, 1e-9);
  EXPECT_GT(rmse("rpe ball.kitti camera.kitti"), 10 * right);
  EXPECT_THAT(run("eval rpe ball.kitti camera.kitti").err, HasSubstr("they do with --axes camera"));
  // In the plane, KITTI's format is a camera's.
  run_ok("convert truth.g2o -q -o flat.kitti");
  run_ok("convert flat.kitti --axes vehicle-to-camera -q -o seen.kitti");
  EXPECT_NEAR(rmse("rpe map.g2o seen.kitti"), rmse("rpe map.g2o truth.g2o"), 1e-9);
  EXPECT_NEAR(rmse("rpe map.g2o flat.kitti --axes vehicle"), rmse("rpe map.g2o truth.g2o"), 1e-9);
  EXPECT_EQ(run("convert map.g2o --axes camera-to-vehicle -o out.g2o").code, 2);
}

TEST_F(TruthMatch, RealTruthOfOtherIds) {
  ISOTHERM_REAL_DATA_OR_SKIP(path, "paper/b25b");
  const auto said = run("label '" + (path / "B25b_0.000.g2o").string() + "' --ground-truth '" +
                        (path / "Bicocca25b_GT_GPS.g2o").string() + "' -o l.csv");
  EXPECT_THAT(said.err, HasSubstr("ground truth: 6580 of 8358 poses have one"));
  EXPECT_THAT(said.err, HasSubstr("the true poses do not move as odometry does"));
}

TEST_F(TruthMatch, RealTruthOfACamera) {
  ISOTHERM_REAL_DATA_OR_SKIP(path, "paper/kitti");
  const auto result = run("eval rpe '" + (path / "kitti_07.g2o").string() + "' '" +
                          (path / "poses_07.txt").string() + "'");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("RPE over 1 pose: mean 0.0"));
}

}  // namespace
