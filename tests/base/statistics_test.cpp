#include "isotherm/base/statistics.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "isotherm/base/error.hpp"

namespace isotherm {
namespace {

TEST(ChiSquared, ClosedFormForTwoDegreesOfFreedom) {
  for (const double p : {0.0, 0.1, 0.5, 0.99, 0.999999}) {
    EXPECT_NEAR(chi_squared_quantile(p, 2), -2.0 * std::log1p(-p), 1e-9);
  }
  EXPECT_NEAR(chi_squared_upper_tail(50.0, 2), std::exp(-25.0), 1e-22);
}

TEST(ChiSquared, PublishedQuantiles) {
  EXPECT_NEAR(chi_squared_quantile(0.95, 3), 7.814728, 1e-6);
  EXPECT_NEAR(chi_squared_quantile(0.999, 6), 22.457744, 1e-6);
}

TEST(ChiSquared, TailInvertsQuantile) {
  for (const int dof : {1, 3, 6, 300}) {
    for (const double p : {0.01, 0.5, 0.999}) {
      EXPECT_NEAR(chi_squared_upper_tail(chi_squared_quantile(p, dof), dof), 1.0 - p, 1e-12);
    }
  }
}

TEST(ChiSquared, EndsAndBadArguments) {
  EXPECT_EQ(chi_squared_upper_tail(std::numeric_limits<double>::infinity(), 3), 0.0);
  EXPECT_EQ(chi_squared_upper_tail(0.0, 3), 1.0);
  EXPECT_THROW(chi_squared_quantile(1.0, 3), InvalidArgument);
  EXPECT_THROW(chi_squared_quantile(0.5, 0), InvalidArgument);
  EXPECT_THROW(chi_squared_upper_tail(std::nan(""), 3), InvalidArgument);
}

TEST(Quantile, IsTheOneWithThisShareBeforeIt) {
  EXPECT_EQ(quantile({7.0}, 0.9), 7.0);
  EXPECT_EQ(quantile({5.0, 1.0, 4.0, 2.0, 3.0}, 0.0), 1.0);
  EXPECT_EQ(quantile({5.0, 1.0, 4.0, 2.0, 3.0}, 0.5), 3.0);
  EXPECT_EQ(quantile({5.0, 1.0, 4.0, 2.0, 3.0}, 0.9), 5.0);
  EXPECT_THROW(quantile({1.0}, 1.0), InvalidArgument);
}

TEST(FisherF, PublishedQuantile) { EXPECT_NEAR(f_quantile(0.95, 3, 10), 3.708265, 1e-6); }

TEST(FisherF, IsChiSquaredOverItsDegreesWhereTheOtherHasMany) {
  for (const double p : {0.1, 0.5, 0.999}) {
    EXPECT_NEAR(f_quantile(p, 6, 1e9), chi_squared_quantile(p, 6) / 6.0, 1e-6);
  }
}

TEST(FisherF, BadArguments) {
  EXPECT_THROW(f_quantile(1.0, 3, 3), InvalidArgument);
  EXPECT_THROW(f_quantile(0.5, 0, 3), InvalidArgument);
  EXPECT_THROW(f_quantile(0.5, 3, std::nan("")), InvalidArgument);
}

TEST(Median, IsTheMiddleOneOrTheMeanOfTwo) {
  EXPECT_EQ(median({7.0}), 7.0);
  EXPECT_EQ(median({9.0, 1.0, 4.0}), 4.0);
  EXPECT_EQ(median({9.0, 1.0, 4.0, 2.0}), 3.0);
  EXPECT_EQ(median({5.0, 5.0, 5.0, 5.0}), 5.0);
}

}  // namespace
}  // namespace isotherm
