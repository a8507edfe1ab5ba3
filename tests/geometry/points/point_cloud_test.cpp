#include "isotherm/geometry/points/point_cloud.hpp"

#include <string>

#include <gtest/gtest.h>

#include "isotherm_test/parse_error.hpp"

namespace isotherm::geometry {
namespace {

PointCloudFile parse(const std::string& text) {
  TextReader reader("f", text);
  return read_points(reader);
}

std::string error_of(const std::string& text) {
  return isotherm_test::parse_error_of([&] { parse(text); });
}

TEST(ReadPoints, WithAndWithoutNames) {
  const auto named = parse("x,y,z\n1,2,3\n-4,5e-1,6\n");
  EXPECT_EQ(named.points.rows(), 3);
  EXPECT_EQ(named.points.col(1), Eigen::Vector3d(-4, 0.5, 6));
  EXPECT_EQ(named.report.records.at("point"), 2u);
  const auto plain = parse("# one axis\n1\n2\n\n3");
  EXPECT_EQ(plain.points, Eigen::RowVector3d(1, 2, 3));
}

TEST(ReadPoints, ErrorsNameLineAndToken) {
  EXPECT_EQ(error_of(""), "f: no point; expected rows of coordinates");
  EXPECT_EQ(error_of("x,y\n"), "f: no point; expected rows of coordinates");
  EXPECT_EQ(error_of("1,2\n3,a\n"), "f:2:3: expected a coordinate, a finite number (got 'a')");
  EXPECT_EQ(error_of("1,2\n3,nan\n"), "f:2:3: expected a coordinate, a finite number (got 'nan')");
  EXPECT_EQ(error_of("1,2\n3,4,5\n"), "f:2:5: expected 2 coordinates, as above (got '5')");
  EXPECT_EQ(error_of("1,2\n3\n"), "f:2: expected a coordinate in field 2, found 1 fields");
  EXPECT_EQ(error_of("x,y\n3\n"), "f:2: expected 2 fields as in the header, found 1");
}

}  // namespace
}  // namespace isotherm::geometry
