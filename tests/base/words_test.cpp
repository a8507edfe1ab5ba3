#include "isotherm/base/words.hpp"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

TEST(Words, CountedAgreesWithItsNumber) {
  EXPECT_EQ(counted(1, "loop"), "1 loop");
  EXPECT_EQ(counted(0, "loop"), "0 loops");
  EXPECT_EQ(counted(12, "vertex", "vertices"), "12 vertices");
}

TEST(Words, NearestIsWhatWasMeantOrNothing) {
  const std::vector<std::string> known = {"prune", "optimize", "info", "neighbours"};
  EXPECT_EQ(nearest_word("prun", known), "prune");
  EXPECT_EQ(nearest_word("purne", known), "prune");
  EXPECT_EQ(nearest_word("optimise", known), "optimize");
  EXPECT_EQ(nearest_word("neighbors", known), "neighbours");
  EXPECT_EQ(nearest_word("fly", known), "");
  EXPECT_EQ(nearest_word("", known), "");
}

}  // namespace
}  // namespace isotherm
