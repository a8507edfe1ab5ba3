#include "isotherm/geometry/points/point_alignment.hpp"

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"

namespace isotherm::geometry {
namespace {

TEST(PointAlignment, FindsAKnownIsometry) {
  Eigen::MatrixXd points(3, 5);
  points << 0, 1, 2, 4, 3, 1, 0, 3, 2, 2, 0, 2, 1, 1, 5;
  Eigen::Matrix3d reflected;  // a quarter turn about z, then a mirror in z
  reflected << 0, -1, 0, 1, 0, 0, 0, 0, -1;
  const Eigen::Vector3d shift(3, -2, 7);
  const Eigen::MatrixXd moved = (reflected * points).colwise() + shift;
  const auto found = align_points(points, moved);
  EXPECT_LT((found.rotation - reflected).norm(), 1e-12);
  EXPECT_LT((found.translation - shift).norm(), 1e-12);
  EXPECT_LT(found.residual, 1e-20);
  EXPECT_GT(found.certainty, 0.1);
}

TEST(PointAlignment, DegenerateInput) {
  Eigen::MatrixXd line(2, 3);
  line << 0, 1, 2, 0, 1, 2;
  EXPECT_LT(align_points(line, line).certainty, 1e-12);
  EXPECT_TRUE(align_points(Eigen::MatrixXd(2, 0), Eigen::MatrixXd(2, 0)).rotation.isIdentity());
  EXPECT_THROW(align_points(line, Eigen::MatrixXd(2, 2)), InvalidArgument);
}

}  // namespace
}  // namespace isotherm::geometry
