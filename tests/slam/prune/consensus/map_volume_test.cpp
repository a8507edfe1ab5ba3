#include "prune/consensus/estimate/map_volume.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace isotherm::slam::detail {
namespace {

// sqrt |2 pi M|.
template <class Pose>
double volume_of(const std::vector<Pose>& poses) {
  const auto variance = MapVolume<Pose>(poses).variance();
  return std::sqrt((2.0 * std::numbers::pi * variance).prod());
}

// Evenly over a square of that length, `turned` about its corner.
std::vector<Pose2> square_of(double length, double turned) {
  constexpr int kSide = 100;
  std::vector<Pose2> poses;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      poses.push_back(Pose2(0.0, 0.0, turned) *
                      Pose2(length * (i + 0.5) / kSide, length * (j + 0.5) / kSide, 1.0));
    }
  }
  return poses;
}

TEST(MapVolume, IsTwiceTheSideADirectionAndEveryRotation) {
  EXPECT_NEAR(volume_of(square_of(50.0, 0.0)), 100.0 * 100.0 * 2.0 * std::numbers::pi, 10.0);
}

TEST(MapVolume, IsTheSameInEveryFrame) {
  EXPECT_NEAR(volume_of(square_of(50.0, 0.6)), volume_of(square_of(50.0, 0.0)), 1e-6);
}

TEST(MapVolume, GoesAsFarOutOfTheFloorOfAFlatMap) {
  std::vector<Pose3> floor;
  for (const Pose2& pose : square_of(50.0, 0.0)) {
    const auto& at = pose.translation();
    floor.emplace_back(Eigen::Vector3d(at.x(), at.y(), 0.0), Eigen::Quaterniond::Identity());
  }
  const double rotations = 8.0 * std::numbers::pi * std::numbers::pi;
  const double side = 2.0 * 50.0 * std::sqrt(2.0 / 3.0);
  EXPECT_NEAR(volume_of(floor), std::pow(side, 3.0) * rotations,
              1e-3 * std::pow(side, 3.0) * rotations);
}

TEST(MapVolume, ThinMapsHaveSomeThickness) {
  const std::vector<Pose3> line = {Pose3(),
                                   Pose3({10.0, 0.0, 0.0}, Eigen::Quaterniond::Identity())};
  EXPECT_GT(volume_of(line), 20.0 * 0.1 * 0.1);
}

TEST(MapVolume, MapsWithoutExtentAreAllowed) {
  for (const auto& poses : {std::vector<Pose2>{}, std::vector<Pose2>(3)}) {
    EXPECT_TRUE((MapVolume<Pose2>(poses).variance().array() > 0.0).all());
  }
}

}  // namespace
}  // namespace isotherm::slam::detail
