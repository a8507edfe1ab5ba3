// The counts of real files, as their collectors state them.
#include <ostream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "isotherm_test/data.hpp"
#include "run_command.hpp"

namespace {

using isotherm_test::CommandTest;
using isotherm_test::write_text;
using Json = nlohmann::json;

class Info : public CommandTest {
 protected:
  Json info(const std::string& path) const {
    return Json::parse(run_ok("info '" + path + "' --json -"));
  }
};

struct Counts {
  const char* file;
  int dimension;
  int vertices;
  int consecutive;
  int others;

  friend void PrintTo(const Counts& counts, std::ostream* out) { *out << counts.file; }
};

class PoseGraphCounts : public Info, public testing::WithParamInterface<Counts> {};

TEST_P(PoseGraphCounts, AreThoseOfTheCollection) {
  ISOTHERM_REAL_DATA_OR_SKIP(path, GetParam().file);
  const auto json = info(path.string());
  EXPECT_EQ(json["content"], "pose-graph");
  EXPECT_EQ(json["dimension"], GetParam().dimension);
  EXPECT_EQ(json["vertices"], GetParam().vertices);
  EXPECT_EQ(json["consecutive_edges"], GetParam().consecutive);
  EXPECT_EQ(json["other_edges"], GetParam().others);
  EXPECT_EQ(json["odometry"].get<int>() + json["candidates"].get<int>(),
            GetParam().consecutive + GetParam().others);
}

INSTANTIATE_TEST_SUITE_P(
    Files, PoseGraphCounts,
    testing::Values(Counts{"paper/b25b/B25b_0.000.g2o", 2, 8358, 8357, 446},
                    Counts{"paper/b25b/B25b_0.100.g2o", 2, 8358, 8357, 401},
                    Counts{"paper/b25b/B25b_0.200.g2o", 2, 8358, 8357, 304},
                    Counts{"paper/b25b/B25b_0.300.g2o", 2, 8358, 8357, 220},
                    Counts{"paper/b25b/B25b_0.450.g2o", 2, 8358, 8357, 137},
                    Counts{"paper/b25b/B25b_0.600.g2o", 2, 8358, 8357, 86},
                    Counts{"paper/b25b/B25b_0.800.g2o", 2, 8358, 8357, 48},
                    Counts{"paper/b25b/B25b_1.000.g2o", 2, 8358, 8357, 23},
                    Counts{"paper/kitti/kitti_00.g2o", 2, 4541, 4540, 136},
                    Counts{"paper/kitti/kitti_02.g2o", 2, 4661, 4660, 43},
                    Counts{"paper/kitti/kitti_06.g2o", 2, 1101, 1100, 50},
                    Counts{"paper/kitti/kitti_07.g2o", 2, 1101, 1100, 6},
                    Counts{"paper/kitti/kitti_09.g2o", 2, 1591, 1590, 2},
                    Counts{"posegraph2d/bovisa04/Bovisa04_odometry_bow_tr.g2o", 2, 11393, 11392,
                           197},
                    Counts{"posegraph2d/intel/intel.g2o", 2, 943, 942, 895},
                    Counts{"posegraph2d/city10000/city10000.g2o", 2, 10000, 9999, 10688},
                    Counts{"posegraph2d/ring/originalDataset/ring.g2o", 2, 434, 433, 26},
                    Counts{"posegraph2d/ringCity/originalDataset/ringCity.g2o", 2, 2361, 2360, 901},
                    Counts{"posegraph2d/CSAIL/CSAIL.g2o", 2, 1045, 1044, 128},
                    Counts{"posegraph2d/MIT/MIT.g2o", 2, 808, 807, 20},
                    Counts{"posegraph2d/ais2klinik/ais2klinik.g2o", 2, 15115, 15113, 1614},
                    Counts{"posegraph3d/sphere2500/sphere2500.g2o", 3, 2500, 2499, 2450},
                    Counts{"posegraph3d/torus3D/torus3D.g2o.gz", 3, 5000, 4999, 4049},
                    Counts{"posegraph3d/cubicle/cubicle.g2o", 3, 5750, 9248, 7621},
                    Counts{"posegraph3d/parking-garage/parking-garage.g2o", 3, 1661, 1660, 4615},
                    Counts{"posegraph3d/smallGrid3D/smallGrid3D.g2o", 3, 125, 124, 173},
                    Counts{"posegraph3d/tinyGrid3D/tinyGrid3D.g2o", 3, 9, 8, 3}));

// Loops to other robots name vertices that only those robots' files have.
struct RobotCounts {
  const char* file;
  int lines;
  int odometry;
  int between;

  friend void PrintTo(const RobotCounts& counts, std::ostream* out) { *out << counts.file; }
};

class RobotFileCounts : public Info, public testing::WithParamInterface<RobotCounts> {};

TEST_P(RobotFileCounts, AreThoseOfTheCollection) {
  ISOTHERM_REAL_DATA_OR_SKIP(path,
                             std::string("multirobot/doorslam_argos_4robots/") + GetParam().file);
  const auto json = info(path.string());
  EXPECT_EQ(json["records"]["VERTEX_SE3:QUAT"], GetParam().lines);
  EXPECT_EQ(json["odometry"], GetParam().odometry);
  EXPECT_EQ(json["candidates"], GetParam().between);
  EXPECT_EQ(json["vertices"].get<int>() - GetParam().lines, json["repairs"]["vertex placed"]);
}

INSTANTIATE_TEST_SUITE_P(Files, RobotFileCounts,
                         testing::Values(RobotCounts{"clean/0.g2o", 110, 109, 23},
                                         RobotCounts{"clean/1.g2o", 110, 109, 68},
                                         RobotCounts{"clean/2.g2o", 110, 109, 54},
                                         RobotCounts{"clean/3.g2o", 110, 109, 16},
                                         RobotCounts{"spoiled/0.g2o", 275, 274, 20},
                                         RobotCounts{"spoiled/1.g2o", 275, 274, 24},
                                         RobotCounts{"spoiled/2.g2o", 275, 274, 33},
                                         RobotCounts{"spoiled/3.g2o", 275, 274, 11}));

TEST_F(Info, PyfgHasRangesAndPoses) {
  ISOTHERM_REAL_DATA_OR_SKIP(path, "snl/plaza1/plaza1.pyfg");
  const auto json = info(path.string());
  EXPECT_EQ(json["content"], "ranges");
  EXPECT_EQ(json["ranges"], 3326);
  EXPECT_EQ(json["landmarks"], 4);
  EXPECT_EQ(json["pose_graph"]["vertices"], 9658);
  EXPECT_EQ(json["pose_graph"]["consecutive_edges"], 9657);
}

TEST_F(Info, DistanceIntervals) {
  ISOTHERM_REAL_DATA_OR_SKIP(path, "snl/mdjeep_sensorSet1/sensor056.nmr");
  EXPECT_EQ(info(path.string())["format"], "intervals");
  EXPECT_EQ(info(path.string())["ranges"], 191);
}

TEST_F(Info, NamesInFilesNeedNotBeUtf8) {
  write_text(folder / "p", "VERTEX_SE2 0 0 0 0\nCAF\xe9 0 1\n");
  EXPECT_EQ(info("p")["skipped"]["CAF\xef\xbf\xbd"], 1);
}

TEST_F(Info, TellsEveryContentAndListsWhatIsOdd) {
  write_text(folder / "t", "1 0 0 0 0 0 0 1\n2 3 4 0 0 0 0 1\n");
  EXPECT_EQ(info("t")["path_length_m"], 5.0);
  write_text(folder / "g", "from,to,weight\n0,1,2\n3,4,5\n");
  EXPECT_EQ(info("g")["components"], 2);
  write_text(folder / "r", "from,to,range\na,b,5\n");
  EXPECT_EQ(info("r")["ranges"], 1);
  write_text(folder / "p",
             "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nVERTEX_SE2 2 2 1 0\n"
             "EDGE_SE2 0 1 1 0 0 4 0 0 4 0 1\nEDGE_SE2 1 2 1 0 0 4 0 0 4 0 1\n"
             "EDGE_SE2 2 0 1 0 0 4 0 0 4 0 0\nEDGE_SE2 0 2 1 0 0 4 1 0 4 0 1\n");
  const auto json = info("p");
  EXPECT_EQ(json["drift"]["path_length_m"], 2.0);
  EXPECT_EQ(json["drift"]["end_distance_m"], 1.0);
  EXPECT_EQ(json["repeated_edges"], 1);
  EXPECT_EQ(json["information"]["candidates"]["singular"], 1);
  EXPECT_EQ(json["information"]["candidates"]["off_diagonal"], 1);
  EXPECT_EQ(json["information"]["odometry"]["median_translation_sigma_m"], 0.5);
  EXPECT_EQ(json["suspicious"]["singular information"], 1);
  const auto text = run_ok("info p");
  EXPECT_THAT(text, testing::HasSubstr("line 7: edge 0 -> 2 repeats the pair of line 6"));
}

}  // namespace
