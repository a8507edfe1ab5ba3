// Conversions from file to file.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run_command.hpp"

namespace {

using isotherm_test::CommandTest;
using isotherm_test::read_text;
using isotherm_test::write_text;
using testing::HasSubstr;

class Convert : public CommandTest {
 protected:
  std::string converted(const std::string& text, const std::string& flags) const {
    write_text(folder / "in", text);
    return run_ok("convert in -o - -q " + flags);
  }
};

constexpr const char* kGraph =
    "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0.1 0.5\nFIX 0\n"
    "EDGE_SE2 0 1 1 0 0.5 10 1 2 20 3 30\n";

TEST_F(Convert, PoseGraphs) {
  EXPECT_EQ(converted(kGraph, "--to g2o"), kGraph);
  const auto toro = converted(kGraph, "--to toro");
  EXPECT_EQ(toro, "VERTEX2 0 0 0 0\nVERTEX2 1 1 0.1 0.5\nEDGE2 0 1 1 0 0.5 10 1 20 30 2 3\n");
  EXPECT_EQ(converted(toro, "--to toro"), toro);
  EXPECT_EQ(converted(kGraph, "--to planar"), "0 0 0 0\n1 1 0.1 0.5\n");
  EXPECT_EQ(converted(kGraph, "--to edges"), "from,to,weight\n0,1,1\n");
  const std::string spatial =
      "VERTEX3 0 1 2 3 0.1 0.2 0.3\n"
      "EDGE3 0 0 1 0 0 0 0 0 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n";
  EXPECT_THAT(converted(spatial, "--to g2o"), HasSubstr("VERTEX_SE3:QUAT 0 1 2 3 0.0342"));
}

TEST_F(Convert, Trajectories) {
  const std::string tum = "1.5 1 2 3 0 0 0 1\n2.5 4 5 6 0 0 0 1\n";
  EXPECT_EQ(converted(tum, "--to tum"), tum);
  EXPECT_EQ(converted(tum, "--to kitti"), "1 0 0 1 0 1 0 2 0 0 1 3\n1 0 0 4 0 1 0 5 0 0 1 6\n");
  const auto euroc = converted(tum, "--to euroc");
  EXPECT_THAT(euroc, HasSubstr("\n1500000000,1,2,3,1,0,0,0\n"));
  EXPECT_EQ(converted(euroc, "--to tum"), tum);
}

TEST_F(Convert, RangesAndGraphs) {
  const std::string pyfg =
      "VERTEX_XY L0 4 6\nEDGE_RANGE 10 A0 L0 5.5 0.25\nEDGE_RANGE 11 A1 L0 4.5 0.25\n";
  const std::string csv = "from,to,range,sigma\nA0,L0,5.5,0.5\nA1,L0,4.5,0.5\n";
  EXPECT_EQ(converted(pyfg, "--to pyfg"), pyfg);
  EXPECT_EQ(converted(pyfg, "--to ranges"), csv);
  EXPECT_EQ(converted(csv, "--to ranges"), csv);
  const std::string matrix =
      "%%MatrixMarket matrix coordinate real symmetric\n3 3 2\n2 1 0.5\n3 2 2\n";
  EXPECT_EQ(converted(matrix, "--to edges"), "from,to,weight\n1,2,0.5\n2,3,2\n");
  EXPECT_EQ(converted("1,2,0.5\n2,3,2\n", "--to matrix-market"), matrix);
  const auto binary = converted("7,2,0.5\n2,3,2\n", "--to binary-graph");
  EXPECT_EQ(binary.size(), 32u + 3 * 8 + 2 * 16);
  EXPECT_EQ(converted(binary, "--to edges"), "from,to,weight\n7,2,0.5\n2,3,2\n");
}

TEST_F(Convert, TakesTheFormatFromTheNameAndCompresses) {
  write_text(folder / "in", kGraph);
  run_ok("convert in -o out.g2o.gz -q");
  EXPECT_EQ(read_text(folder / "out.g2o.gz").substr(0, 2), "\x1f\x8b");
  EXPECT_EQ(run_ok("convert out.g2o.gz -o - --to g2o -q"), kGraph);
  const auto unknown = run("convert in -o out.dat");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("--to"));
}

TEST_F(Convert, RefusesWhatMakesNoSense) {
  write_text(folder / "in", "0,1,1\n");
  for (const char* target : {"g2o", "tum", "ranges", "points"}) {
    EXPECT_EQ(run("convert in -o out.x --to " + std::string(target)).code, 2) << target;
  }
  EXPECT_EQ(run("convert in -o out.x --to magic").code, 2);
  write_text(folder / "in", kGraph);
  EXPECT_EQ(run("convert in -o out.x --to pyfg").code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder / "out.x"));
}

}  // namespace
