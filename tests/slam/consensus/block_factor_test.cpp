#include "consensus/block_factor.hpp"

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "isotherm/base/random.hpp"

namespace isotherm::slam::detail {
namespace {

// A sparse block matrix with its dense twin.
template <int Dof>
struct System {
  std::vector<std::pair<Index, Index>> pairs;
  BlockFactor<Dof> factor;
  Eigen::MatrixXd dense;
};

template <int Dof>
System<Dof> random_system(Random& random, Index count, int pair_count) {
  using Block = Eigen::Matrix<double, Dof, Dof>;
  std::vector<std::pair<Index, Index>> pairs;
  while (static_cast<int>(pairs.size()) < pair_count) {
    const auto a = static_cast<Index>(random.index(count));
    const auto b = static_cast<Index>(random.index(count));
    if (a != b) pairs.emplace_back(a, b);
  }
  pairs.push_back(pairs.front());  // repeats share their block
  System<Dof> system{pairs, BlockFactor<Dof>(count, pairs),
                     Eigen::MatrixXd::Zero(count * Dof, count * Dof)};
  const auto random_block = [&random] {
    Block block;
    for (int k = 0; k < block.size(); ++k) block(k) = random.normal();
    return block;
  };
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const Block block = random_block();
    const auto [a, b] = pairs[k];
    system.factor.add_pair(k, block);
    system.dense.template block<Dof, Dof>(a * Dof, b * Dof) += block;
    system.dense.template block<Dof, Dof>(b * Dof, a * Dof) += block.transpose();
  }
  for (Index a = 0; a < count; ++a) {
    const Block diagonal = 20.0 * Block::Identity();
    system.factor.add_diagonal(a, diagonal);
    system.dense.template block<Dof, Dof>(a * Dof, a * Dof) += diagonal;
  }
  return system;
}

template <class Size>
class BlockFactorOf : public testing::Test {};
using Sizes = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 6>>;
TYPED_TEST_SUITE(BlockFactorOf, Sizes);

TYPED_TEST(BlockFactorOf, SolvesLikeTheDenseMatrix) {
  constexpr int kDof = TypeParam::value;
  Random random(1);
  for (const Index count : {2, 5, 30}) {
    auto system = random_system<kDof>(random, count, count);
    ASSERT_TRUE(system.factor.factorise());
    Eigen::VectorXd b(count * kDof);
    for (auto& entry : b) entry = random.normal();
    Eigen::VectorXd x = b;
    system.factor.solve(x);
    EXPECT_LT((system.dense * x - b).norm(), 1e-10);
  }
}

TYPED_TEST(BlockFactorOf, QuadraticFormsAgreeWithTheDenseInverse) {
  constexpr int kDof = TypeParam::value;
  using Block = Eigen::Matrix<double, kDof, kDof>;
  Random random(2);
  const Index count = 25;
  auto system = random_system<kDof>(random, count, 40);
  ASSERT_TRUE(system.factor.factorise());
  const Eigen::MatrixXd inverse = system.dense.inverse();
  auto workspace = system.factor.make_workspace();
  for (Index a = -1; a < count; a += 3) {
    for (Index b = 0; b < count; b += 2) {
      if (a == b) continue;
      const Block Ba = Block::Random();
      const Block Bb = Block::Random();
      Eigen::MatrixXd B = Eigen::MatrixXd::Zero(count * kDof, kDof);
      if (a >= 0) B.template middleRows<kDof>(a * kDof) = Ba;
      B.template middleRows<kDof>(b * kDof) = Bb;
      const Block expected = B.transpose() * inverse * B;
      EXPECT_LT((system.factor.quadratic_form(workspace, a, Ba, b, Bb) - expected).norm(), 1e-10);
    }
  }
}

TYPED_TEST(BlockFactorOf, TellsIndefiniteMatricesAndStartsAgain) {
  constexpr int kDof = TypeParam::value;
  using Block = Eigen::Matrix<double, kDof, kDof>;
  const std::vector<std::pair<Index, Index>> pairs = {{0, 1}};
  BlockFactor<kDof> factor(2, pairs);
  factor.add_diagonal(0, Block::Identity());
  factor.add_diagonal(1, Block::Identity());
  factor.add_pair(0, 2.0 * Block::Identity());
  EXPECT_FALSE(factor.factorise());
  factor.clear();
  factor.add_diagonal(0, Block::Identity());
  factor.add_diagonal(1, Block::Identity());
  EXPECT_TRUE(factor.factorise());
}

TYPED_TEST(BlockFactorOf, EmptyMatrixHasAFactor) {
  BlockFactor<TypeParam::value> factor(0, {});
  EXPECT_TRUE(factor.factorise());
  Eigen::VectorXd nothing;
  factor.solve(nothing);
  EXPECT_EQ(nothing.size(), 0);
}

// Along a chain a half-solve must not depend on the other blocks' number: the order
// keeps the elimination tree sparse.
TYPED_TEST(BlockFactorOf, ChainsDoNotFillIn) {
  std::vector<std::pair<Index, Index>> pairs;
  for (Index k = 0; k + 1 < 1000; ++k) pairs.emplace_back(k, k + 1);
  EXPECT_EQ((BlockFactor<TypeParam::value>(1000, pairs).fill()), 999u);
}

}  // namespace
}  // namespace isotherm::slam::detail
