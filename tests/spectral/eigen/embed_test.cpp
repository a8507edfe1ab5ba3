#include "isotherm/spectral/eigen/embed.hpp"

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"

namespace isotherm::spectral {
namespace {

// Resistances in series add up.
TEST(Embed, CommuteTimesOfAPathAreItsSteps) {
  const WeightedGraph path(5, {{0, 1}, {1, 2}, {2, 3}, {3, 4}});
  const auto result = embed(path, {.dimensions = 10});
  EXPECT_EQ(result.available, 4);
  ASSERT_EQ(result.rows.cols(), 4);
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      EXPECT_NEAR((result.rows.row(i) - result.rows.row(j)).squaredNorm(), std::abs(i - j), 1e-9);
    }
  }
}

TEST(Embed, HeatTellsComponentsApartFirst) {
  const WeightedGraph two(4, {{0, 1}, {2, 3}});
  const auto result = embed(two, {.method = Embedding::heat, .dimensions = 2});
  EXPECT_EQ(result.components, 2);
  ASSERT_EQ(result.rows.cols(), 2);
  EXPECT_NEAR((result.rows.row(0) - result.rows.row(1)).norm(), 0.0, 1e-12);
  EXPECT_GT((result.rows.row(0) - result.rows.row(2)).norm(), 0.5);
}

TEST(Embed, NamesTheOptionThatIsOutOfRange) {
  EXPECT_THROW(embed(WeightedGraph(), {.dimensions = 0}), InvalidArgument);
}

}  // namespace
}  // namespace isotherm::spectral
