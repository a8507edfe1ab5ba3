#include "isotherm/slam/optimize/robust_kernel.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace isotherm::slam {
namespace {

constexpr RobustKernel kKernels[] = {RobustKernel::none, RobustKernel::huber, RobustKernel::cauchy,
                                     RobustKernel::dcs};

TEST(RobustKernel, WeightIsTheDerivativeOfTheCost) {
  for (const auto kernel : kKernels) {
    for (const double width : {0.5, 1.0, 7.0}) {
      for (const double chi2 : {0.01, 0.3, 2.0, 30.0, 1e4}) {
        const double h = 1e-5 * chi2;
        const double numeric = (evaluate_kernel(kernel, width, chi2 + h).cost -
                                evaluate_kernel(kernel, width, chi2 - h).cost) /
                               (2 * h);
        const double weight = evaluate_kernel(kernel, width, chi2).weight;
        EXPECT_NEAR(weight, numeric, 1e-6 * (weight + 1e-3)) << enum_name(kernel) << " " << chi2;
      }
    }
  }
}

TEST(RobustKernel, SmallChiSquaredCountsInFull) {
  for (const auto kernel : kKernels) {
    EXPECT_EQ(evaluate_kernel(kernel, 2.0, 0.0).cost, 0.0);
    EXPECT_EQ(evaluate_kernel(kernel, 2.0, 0.0).weight, 1.0);
    EXPECT_EQ(evaluate_kernel(kernel, 2.0, -1e-20).weight, 1.0) << "rounding below zero";
  }
}

TEST(RobustKernel, PublishedFormOfDynamicCovarianceScaling) {
  const double phi = 3.0;
  for (const double chi2 : {1.0, 3.0, 10.0, 1e6}) {
    const double s = std::min(1.0, 2.0 * phi / (phi + chi2));
    EXPECT_DOUBLE_EQ(evaluate_kernel(RobustKernel::dcs, phi, chi2).weight, s * s);
  }
  EXPECT_NEAR(evaluate_kernel(RobustKernel::dcs, phi, 1e12).cost, 3.0 * phi, 1e-9);
}

}  // namespace
}  // namespace isotherm::slam
