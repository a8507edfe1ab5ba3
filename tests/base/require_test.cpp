#include "isotherm/base/require.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace isotherm {
namespace {

TEST(RequirePositive, NamesTheOption) {
  EXPECT_NO_THROW(require_positive("weight", 1e-300));
  using Limits = std::numeric_limits<double>;
  for (const double value : {0.0, -1.0, Limits::infinity(), Limits::quiet_NaN()}) {
    try {
      require_positive("weight", value);
      FAIL() << value;
    } catch (const InvalidArgument& error) {
      EXPECT_EQ(error.option(), "weight");
    }
  }
}

}  // namespace
}  // namespace isotherm
