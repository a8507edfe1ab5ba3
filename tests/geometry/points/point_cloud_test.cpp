#include "isotherm/geometry/points/point_cloud.hpp"

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "isotherm_test/parse_error.hpp"
#include "isotherm_test/temporary.hpp"

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

TEST(ReadPoints, AColumnOfNumbersIsNoCoordinate) {
  const auto file = parse("id,x,y\n12,1,2\n7,3,4\n");
  EXPECT_EQ(file.points.rows(), 2);
  EXPECT_EQ(file.points.col(0), Eigen::Vector2d(3, 4));
  EXPECT_THAT(file.ids, testing::ElementsAre(7, 12));
  EXPECT_THAT(parse("x,node\n1,5\n").ids, testing::ElementsAre(5));
  EXPECT_THAT(parse("1,2\n3,4\n").ids, testing::ElementsAre(0, 1));
  EXPECT_EQ(error_of("id,x\n7,1\n7,2\n"), "f: two points have this number (got '7')");
  EXPECT_EQ(error_of("id\n7\n"),
            "f:2:1: expected coordinates beside the number of a point (got '7')");
}

// What numpy.save writes, version 1.0.
std::string npy(const std::string& description, const std::string& numbers) {
  std::string header = description;
  header.resize(118, ' ');
  return std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header + numbers;
}

template <class Number>
std::string bytes(std::initializer_list<Number> numbers) {
  return {reinterpret_cast<const char*>(numbers.begin()), numbers.size() * sizeof(Number)};
}

class ReadNpy : public testing::Test {
 protected:
  PointCloudFile read(const std::string& content) {
    isotherm_test::write_file(folder_ / "a.npy", content);
    return read_points(folder_ / "a.npy");
  }
  std::string error(const std::string& content) {
    const auto message = isotherm_test::parse_error_of([&] { read(content); });
    return message.substr(message.find("NumPy"));
  }
  isotherm_test::TemporaryFolder folder_;
};

TEST_F(ReadNpy, InEitherOrderAndType) {
  const Eigen::MatrixXd expected = (Eigen::MatrixXd(3, 2) << 1, 4, 2, 5, 3, 6).finished();
  EXPECT_EQ(read(npy("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }",
                     bytes<double>({1, 2, 3, 4, 5, 6})))
                .points,
            expected);
  EXPECT_EQ(read(npy("{'descr': '<f4', 'fortran_order': True, 'shape': (2, 3), }",
                     bytes<float>({1, 4, 2, 5, 3, 6})))
                .points,
            expected);
  const auto file = read(npy("{'descr': '<i4', 'fortran_order': False, 'shape': (2, 3), }",
                             bytes<std::int32_t>({1, 2, 3, 4, 5, 6})));
  EXPECT_EQ(file.points, expected);
  EXPECT_THAT(file.ids, testing::ElementsAre(0, 1));
  EXPECT_EQ(file.report.format, "npy");
}

TEST_F(ReadNpy, DamageIsToldAndCostsNoMemory) {
  const std::string two = "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 2), }";
  EXPECT_EQ(error(npy(two, bytes<double>({1}))),
            "NumPy array: has 8 bytes of numbers, expected 16");
  EXPECT_EQ(error(std::string("\x93NUMPY\x01\x00\xff\xff", 10)),
            "NumPy array: the file ends early");
  EXPECT_EQ(error(npy("{'descr': '<f8', 'fortran_order': False, 'shape': (4000000000, 9), }", "")),
            "NumPy array: the file ends early");
  EXPECT_EQ(error(npy("{'descr': '<f8', 'fortran_order': False, 'shape': (8,), }", "")),
            "NumPy array: expected two axes, points and coordinates (got '(8,)')");
  EXPECT_EQ(error(npy("{'descr': '|O', 'fortran_order': False, 'shape': (1, 1), }", "aaaaaaaa")),
            "NumPy array: expected little-endian floats or integers of 4 or 8 bytes (got '|O')");
  EXPECT_EQ(error(npy(two, bytes<double>({1, std::nan("")}))),
            "NumPy array: holds a number that is not finite");
  EXPECT_EQ(error(npy("{}", "")), "NumPy array: no 'descr': in its header");
}

}  // namespace
}  // namespace isotherm::geometry
