#include "isotherm/spectral/sparse/earlier_factor.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "isotherm/base/error.hpp"
#include "isotherm/base/random.hpp"

namespace isotherm::spectral {
namespace {

constexpr Index kCount = 40;

// A ring of springs with random strengths between 1 and `most`, held softly everywhere; what is
// set up is added to a dense copy.
Eigen::MatrixXd set_up(Random& random, double most, BlockCholesky& blocks) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(3 * kCount, 3 * kCount);
  blocks.clear();
  const Eigen::Matrix3d unit = Eigen::Matrix3d::Identity();
  for (Index k = 0; k < kCount; ++k) {
    const Index next = (k + 1) % kCount;
    const Eigen::Matrix3d spring = std::pow(most, random.uniform()) * unit;
    blocks.add_diagonal(k, (spring + 0.1 * unit).eval());
    blocks.add_diagonal(next, spring);
    blocks.add_pair(static_cast<std::size_t>(k), (-spring).eval());
    dense.block<3, 3>(3 * k, 3 * k) += spring + 0.1 * unit;
    dense.block<3, 3>(3 * next, 3 * next) += spring;
    dense.block<3, 3>(3 * k, 3 * next) -= spring;
    dense.block<3, 3>(3 * next, 3 * k) -= spring;
  }
  return dense;
}

BlockCholesky ring() {
  std::vector<std::pair<Index, Index>> pairs;
  for (Index k = 0; k < kCount; ++k) pairs.emplace_back(k, (k + 1) % kCount);
  return {3, kCount, pairs};
}

TEST(EarlierFactor, SolvesForValuesThatAreNear) {
  Random random(3);
  auto blocks = ring();
  set_up(random, 1.5, blocks);
  ASSERT_TRUE(blocks.factorise());
  const Eigen::MatrixXd dense = set_up(random, 1.5, blocks);
  const Eigen::VectorXd rhs = Eigen::VectorXd::LinSpaced(3 * kCount, -1.0, 2.0);
  const auto x = solve_by_earlier_factor(blocks, rhs);
  ASSERT_TRUE(x);
  const Eigen::VectorXd error = *x - dense.llt().solve(rhs);
  EXPECT_LT(error.dot(dense * error), 1e-3 * x->dot(dense * *x));
  EXPECT_GT(error.norm(), 1e-12) << "the factor is of other values";
}

TEST(EarlierFactor, GivesUpWhereValuesAreFarOff) {
  Random random(4);
  auto blocks = ring();
  set_up(random, 1e6, blocks);
  ASSERT_TRUE(blocks.factorise());
  set_up(random, 1e6, blocks);
  EXPECT_FALSE(solve_by_earlier_factor(blocks, Eigen::VectorXd::LinSpaced(3 * kCount, 0.0, 1.0)));
}

TEST(EarlierFactor, DegenerateSystems) {
  Random random(5);
  auto blocks = ring();
  set_up(random, 2.0, blocks);
  EXPECT_THROW(solve_by_earlier_factor(blocks, Eigen::VectorXd::Ones(3 * kCount)), NumericalError);
  ASSERT_TRUE(blocks.factorise());
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(3 * kCount);
  EXPECT_EQ(solve_by_earlier_factor(blocks, none), none);
  blocks.clear();
  EXPECT_FALSE(solve_by_earlier_factor(blocks, Eigen::VectorXd::Ones(3 * kCount)));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(solve_by_earlier_factor(blocks, Eigen::VectorXd::Constant(3 * kCount, nan)));
  EXPECT_EQ(solve_by_earlier_factor(BlockCholesky(3, 0, {}), {})->size(), 0);
}

}  // namespace
}  // namespace isotherm::spectral
