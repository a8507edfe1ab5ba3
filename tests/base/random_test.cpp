#include "isotherm/base/random.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"

namespace isotherm {
namespace {

TEST(Random, SameSeedSameSequence) {
  Random a(42);
  Random b(42);
  Random c(43);
  bool differs = false;
  for (int i = 0; i < 100; ++i) {
    const double x = a.normal();
    EXPECT_EQ(x, b.normal());
    differs = differs || x != c.normal();
  }
  EXPECT_TRUE(differs);
}

TEST(Random, UniformStaysInRangeAndFillsIt) {
  Random random(1);
  double sum = 0.0;
  for (int i = 0; i < 10000; ++i) {
    const double x = random.uniform(-2.0, 3.0);
    ASSERT_GE(x, -2.0);
    ASSERT_LT(x, 3.0);
    sum += x;
  }
  // Standard error of the mean: 5 / sqrt(12 * 10000) = 0.0144.
  EXPECT_NEAR(sum / 10000, 0.5, 5 * 0.0144);
}

TEST(Random, NormalHasItsMoments) {
  Random random(2);
  const int n = 20000;
  double sum = 0.0;
  double squares = 0.0;
  double fourth = 0.0;
  for (int i = 0; i < n; ++i) {
    const double z = (random.normal(3.0, 2.0) - 3.0) / 2.0;
    sum += z;
    squares += z * z;
    fourth += z * z * z * z;
  }
  EXPECT_NEAR(sum / n, 0.0, 5 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1.0, 5 * std::sqrt(2.0 / n));
  EXPECT_NEAR(fourth / n, 3.0, 5 * std::sqrt(96.0 / n));
}

TEST(Random, IndexIsUniform) {
  Random random(3);
  std::vector<int> counts(7, 0);
  const int n = 70000;
  for (int i = 0; i < n; ++i) ++counts.at(random.index(7));
  // Binomial standard deviation: sqrt(70000 * 1/7 * 6/7) = 92.6.
  for (const int count : counts) EXPECT_NEAR(count, 10000, 5 * 92.6);
  EXPECT_EQ(random.index(1), 0u);
  EXPECT_THROW(random.index(0), InvalidArgument);
}

}  // namespace
}  // namespace isotherm
