#include "localize/fold/mirror_image.hpp"

#include <limits>

#include <gtest/gtest.h>
#include <Eigen/SVD>

#include "isotherm/base/random.hpp"

namespace isotherm::network::detail {
namespace {

Tie shared_point(const Point& point) { return {point, point, 0.0, 1.0, {1e6, 1e6}}; }

/// Least sum of squares of an improper rotation and a translation, by the singular values
/// of the covariance (Kabsch, with the sign of the determinant turned).
double improper_procrustes(const Eigen::MatrixXd& points) {
  const Eigen::MatrixXd centred = points.colwise() - points.rowwise().mean();
  const auto values = (centred * centred.transpose()).jacobiSvd().singularValues();
  return 2.0 * values.sum() - 2.0 * (values.sum() - 2.0 * values.minCoeff());
}

/// That a mirror image costs this, within `error`, and none less.
void expect_cost(const TiedBody& body, double cost, double error, const PointsCost& points = {}) {
  EXPECT_TRUE(has_mirror_image(body, cost + error, points));
  EXPECT_FALSE(has_mirror_image(body, cost - error, points));
}

TEST(MirrorImage, OfSharedPointsIsTheBestImproperRotation) {
  Random random(4);
  for (const int d : {2, 3}) {
    Eigen::MatrixXd points(d, 4);
    for (auto& value : points.reshaped()) value = random.uniform(-3.0, 3.0);
    std::vector<Tie> ties;
    for (const auto& point : points.colwise()) ties.push_back(shared_point(point));
    expect_cost({ties}, improper_procrustes(points), 1e-4);
  }
}

TEST(MirrorImage, CostsNothingOnAHinge) {
  const std::vector<Tie> hinge = {shared_point(Eigen::Vector2d(0, 0)),
                                  shared_point(Eigen::Vector2d(2, 1))};
  expect_cost({hinge}, 0.0, 1e-12);
}

TEST(MirrorImage, ARangeAcrossTheHingeSpeaksAgainstIt) {
  // The body hangs on two points of the x axis; its third point, above, has a range to
  // one below. Mirrored it would be 2 instead of 4 away.
  std::vector<Tie> ties = {shared_point(Eigen::Vector2d(-5, 0)),
                           shared_point(Eigen::Vector2d(5, 0))};
  ties.push_back({Eigen::Vector2d(0, 3), Eigen::Vector2d(0, -1), 4.0, 0.1, {50.0, 50.0}});
  EXPECT_DOUBLE_EQ(ties.back().cost(), 0.0);
  EXPECT_FALSE(has_mirror_image({ties}, 2.0));  // shifting the hinge by 2 costs 2 * 1 each
  EXPECT_TRUE(has_mirror_image({ties}, 50.1));  // giving up the range
}

TEST(MirrorImage, ThePlacesOfItsPointsCount) {
  // On a hinge along the x axis the mirror image of a point at (1, 2) is at (1, -2).
  TiedBody body{{shared_point(Eigen::Vector2d(0, 0)), shared_point(Eigen::Vector2d(2, 0))},
                {Eigen::Vector2d(1, 2)}};
  const auto cost = [](const std::vector<Point>& places) {
    return 3.0 + (places.front() - Eigen::Vector2d(1, -2)).norm();
  };
  expect_cost(body, 3.0, 1e-9, cost);
}

TEST(MirrorImage, ARangeHasALimitOnEitherSide) {
  const Tie tie{Eigen::Vector2d(0, 0), Eigen::Vector2d(5, 0), 2.0, 0.1, {7.0, 4.0}};
  EXPECT_DOUBLE_EQ(tie.cost(), 7.0);
  auto close = tie;
  close.distance = 9.0;
  EXPECT_DOUBLE_EQ(close.cost(), 4.0);
}

TEST(MirrorImage, WithoutEnoughTiesIsImpossible) {
  EXPECT_FALSE(has_mirror_image({{}}, std::numeric_limits<double>::infinity()));
}

}  // namespace
}  // namespace isotherm::network::detail
