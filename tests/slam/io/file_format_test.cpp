#include "isotherm/slam/io/file_format.hpp"

#include <string>

#include <gtest/gtest.h>

namespace isotherm::slam {
namespace {

std::string_view detected(const std::string& text) {
  TextReader reader("f", text);
  const auto format = detect_format(reader);
  EXPECT_EQ(reader.line_number(), 0u) << "nothing is consumed";
  return enum_name(format);
}

TEST(DetectFormat, ByTheFirstRecordThatTells) {
  EXPECT_EQ(detected("# comment\n\nUNKNOWN 1 2\nVERTEX_SE2 0 0 0 0\n"), "g2o");
  EXPECT_EQ(detected("EDGE_SE3:QUAT 0 1"), "g2o");
  EXPECT_EQ(detected("VERTEX_SE2 0 1,5 0 0\n"), "g2o");
  EXPECT_EQ(detected("EDGE2 0 1 1 0 0\n"), "toro");
  EXPECT_EQ(detected("VERTEX_SE2 1.5 A0 0 0 0\n"), "pyfg");
  EXPECT_EQ(detected("VERTEX_XY L0 0 0\n"), "pyfg");
  EXPECT_EQ(detected("1 0 0 0 0 0 0 1\n"), "tum");
  EXPECT_EQ(detected("1 0 0 0 0 1 0 0 0 0 1 0\n"), "kitti");
  EXPECT_EQ(detected("7 1 0 0 0 0 1 0 0 0 0 1 0\r\n"), "kitti");
  EXPECT_EQ(detected("#timestamp [ns],x\n"), "euroc");
  EXPECT_EQ(detected("14,1,2,3,1,0,0,0,0,0,0\n"), "euroc");
  EXPECT_EQ(detected("0 0 0 0\n1 1 0 0.5\n"), "planar");
  EXPECT_EQ(detected("time,x,y,theta\n"), "planar");
  EXPECT_EQ(detected("point2 0 1 2 0 0 0 0\n"), "points");
  EXPECT_EQ(detected("from,to,range\n"), "ranges");
  EXPECT_EQ(detected("range2 0 1 2\n"), "librsf");
  EXPECT_EQ(detected("1 2 0 0.6\n1 3 0.5 0.5\n"), "intervals");
  EXPECT_EQ(detected("1 2 0.5 0.6\n2 3.5 0.5 0.7\n"), "planar");
  EXPECT_EQ(detected("0 1\n"), "edges");
  EXPECT_EQ(detected("from,to\n0,1\n"), "edges");
  EXPECT_EQ(detected("%%MatrixMarket matrix\n"), "matrix-market");
  EXPECT_EQ(detected(""), "unknown");
  EXPECT_EQ(detected("1 2 3 4 5\n"), "unknown");
}

TEST(RequireFormat, SaysWhatIsKnown) {
  TextReader empty("f", "");
  EXPECT_THROW(require_format(empty), ParseError);
  TextReader prose("f", "hello\n");
  EXPECT_THROW(require_format(prose), ParseError);
}

}  // namespace
}  // namespace isotherm::slam
