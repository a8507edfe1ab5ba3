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

TEST(MapVolume, IsTwiceTheExtentADirectionAndEveryRotation) {
  const std::vector<Pose2> square = {Pose2(0.0, 0.0, 0.0), Pose2(50.0, 0.0, 1.0),
                                     Pose2(50.0, 50.0, 2.0)};
  EXPECT_NEAR(volume_of(square), 100.0 * 100.0 * 2.0 * std::numbers::pi, 1e-6);
  const std::vector<Pose3> box = {Pose3(), Pose3({10.0, 5.0, 2.0}, Eigen::Quaterniond::Identity())};
  const double rotations = 8.0 * std::numbers::pi * std::numbers::pi;
  EXPECT_NEAR(volume_of(box), 20.0 * 10.0 * 4.0 * rotations, 1e-6);
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
