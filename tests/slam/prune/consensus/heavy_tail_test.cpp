#include "prune/consensus/calibrate/heavy_tail.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "isotherm/base/random.hpp"
#include "isotherm/base/statistics.hpp"
#include "slam/prune/consensus/chi_squared_sample.hpp"

namespace isotherm::slam::detail {
namespace {

constexpr double kTail = 1e-3;

using isotherm_test::chi_squared;

std::vector<double> gaussian_sample(int count, int dof, double scale) {
  Random random(61);
  return isotherm_test::chi_squared_sample(random, count, dof, scale);
}

TEST(StudentTail, OfGaussianErrorsIsThatOfChiSquared) {
  for (const int dof : {3, 6}) {
    for (const double scale : {1e-4, 1.0, 50.0}) {
      const Tail tail = student_tail(gaussian_sample(40000, dof, scale), dof, kTail);
      const double exact = scale * chi_squared_quantile(1.0 - kTail, dof);
      EXPECT_NEAR(tail.quantile / exact, 1.15, 0.15) << dof << " " << scale;  // a little wider
      EXPECT_NEAR(tail.factor, 1.15, 0.15) << dof << " " << scale;
    }
  }
}

TEST(StudentTail, OfStudentsErrorsIsThatOfF) {
  Random random(62);
  for (const int nu : {3, 5}) {
    std::vector<double> sample(40000);
    for (double& x : sample) x = chi_squared(random, 6) / (chi_squared(random, nu) / nu);
    const Tail tail = student_tail(sample, 6, kTail);
    const double exact = 6.0 * f_quantile(1.0 - kTail, 6, nu);
    EXPECT_GT(tail.quantile, exact) << nu;
    EXPECT_LT(tail.quantile, 1.5 * exact) << nu;
  }
}

TEST(StudentTail, AFewFalseOnesHardlyChangeIt) {
  auto sample = gaussian_sample(4000, 6, 1.0);
  const Tail clean = student_tail(sample, 6, kTail);
  for (int k = 0; k < 40; ++k) sample.push_back(1e6);
  const Tail polluted = student_tail(sample, 6, kTail);
  EXPECT_GE(polluted.quantile, clean.quantile);
  EXPECT_LT(polluted.quantile, 1.3 * clean.quantile);
}

TEST(StudentTail, AFewValuesMayHaveAnyTail) {
  EXPECT_GT(student_tail(gaussian_sample(10, 3, 1.0), 3, kTail).factor, 10.0);
  EXPECT_GT(student_tail({2.0}, 3, kTail).factor, 10.0);
}

TEST(StudentTail, OfNoErrorsIsPositive) {
  const Tail tail = student_tail(std::vector<double>(1000, 0.0), 6, kTail);
  EXPECT_GT(tail.quantile, 0.0);
  EXPECT_LT(tail.quantile, 1e-6);
}

}  // namespace
}  // namespace isotherm::slam::detail
