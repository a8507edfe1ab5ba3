#include "isotherm/spectral/sparse/block_cholesky.hpp"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "isotherm/base/error.hpp"
#include "isotherm/base/random.hpp"

namespace isotherm::spectral {
namespace {

using Pairs = std::vector<std::pair<Index, Index>>;

Eigen::MatrixXd random_matrix(Random& random, int rows, int columns) {
  Eigen::MatrixXd m(rows, columns);
  for (Eigen::Index i = 0; i < m.size(); ++i) m.data()[i] = random.normal();
  return m;
}

// The same random positive definite matrix, in blocks and dense.
struct Twin {
  BlockCholesky blocks;
  Eigen::MatrixXd dense;
};

Twin random_twin(Random& random, int size, Index count, const Pairs& pairs,
                 FactorForm form = FactorForm::fastest) {
  Twin twin{BlockCholesky(size, count, pairs, form),
            Eigen::MatrixXd::Zero(count * size, count * size)};
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [row, column] = pairs[k];
    const Eigen::MatrixXd block = random_matrix(random, size, size);
    twin.blocks.add_pair(k, block);
    twin.dense.block(row * size, column * size, size, size) += block;
    twin.dense.block(column * size, row * size, size, size) += block.transpose();
  }
  for (Index v = 0; v < count; ++v) {
    const Eigen::MatrixXd root = random_matrix(random, size, size);
    const Eigen::MatrixXd block =
        root * root.transpose() + 40.0 * Eigen::MatrixXd::Identity(size, size);
    twin.blocks.add_diagonal(v, block);
    twin.dense.block(v * size, v * size, size, size) += block;
  }
  return twin;
}

TEST(BlockCholesky, SolvesAsADenseFactorDoes) {
  Random random(5);
  const Pairs pairs = {{0, 1}, {2, 1}, {1, 2}, {4, 0}, {3, 5}, {5, 3}};
  for (const int size : {1, 2, 3, 6}) {
    auto [blocks, dense] = random_twin(random, size, 6, pairs);
    ASSERT_TRUE(blocks.factorise());
    const Eigen::MatrixXd rhs = random_matrix(random, 6 * size, 3);
    EXPECT_LT((blocks.solve(rhs) - dense.llt().solve(rhs)).norm(), 1e-12) << size;
    EXPECT_LT((blocks.multiply(rhs.col(0)) - dense * rhs.col(0)).norm(), 1e-12);
    EXPECT_LT((blocks.diagonal() - dense.diagonal()).norm(), 1e-15);
  }
}

TEST(BlockCholesky, DampingIsForOneFactorisationOnly) {
  Random random(6);
  auto [blocks, dense] = random_twin(random, 3, 4, {{0, 1}, {1, 2}, {2, 3}});
  const Eigen::VectorXd damping = Eigen::VectorXd::LinSpaced(12, 1.0, 12.0);
  const Eigen::VectorXd rhs = random_matrix(random, 12, 1);
  ASSERT_TRUE(blocks.factorise(damping));
  const Eigen::MatrixXd damped = dense + Eigen::MatrixXd(damping.asDiagonal());
  EXPECT_LT((blocks.solve(rhs) - damped.llt().solve(rhs)).norm(), 1e-13);
  EXPECT_EQ(blocks.diagonal(), dense.diagonal());
  ASSERT_TRUE(blocks.factorise());
  EXPECT_LT((blocks.solve(rhs) - dense.llt().solve(rhs)).norm(), 1e-13);
}

TEST(BlockCholesky, SaysWhenTheMatrixIsNotDefinite) {
  BlockCholesky blocks(2, 2, Pairs{{0, 1}});
  blocks.add_diagonal(0, Eigen::Matrix2d(Eigen::Matrix2d::Identity()));
  blocks.add_diagonal(1, Eigen::Matrix2d(-Eigen::Matrix2d::Identity()));
  EXPECT_FALSE(blocks.factorise());
  EXPECT_THROW(blocks.solve(Eigen::VectorXd::Ones(4)), NumericalError);
  EXPECT_TRUE(blocks.factorise(Eigen::VectorXd::Constant(4, 3.0)));
  blocks.clear();
  EXPECT_FALSE(blocks.factorise()) << "all zero";
}

TEST(BlockCholesky, LargeEnoughForSupernodes) {
  Random random(7);
  Pairs pairs;
  const Index count = 60;
  for (Index i = 0; i < count; ++i) {
    for (Index j = 0; j < i; ++j) pairs.emplace_back(i, j);
  }
  auto [blocks, dense] = random_twin(random, 6, count, pairs);
  const Eigen::VectorXd damping = Eigen::VectorXd::Constant(6 * count, 1e3);
  ASSERT_TRUE(blocks.factorise(damping));
  const Eigen::VectorXd rhs = random_matrix(random, 6 * count, 1);
  const Eigen::MatrixXd damped = dense + Eigen::MatrixXd(damping.asDiagonal());
  EXPECT_LT((blocks.solve(rhs) - damped.ldlt().solve(rhs)).norm(), 1e-12);
}

TEST(BlockCholesky, LogDeterminantIsThatOfADenseFactor) {
  Random random(8);
  const Pairs pairs = {{0, 1}, {2, 1}, {3, 0}, {4, 0}, {3, 5}, {5, 1}};
  for (const FactorForm form : {FactorForm::fastest, FactorForm::supernodal}) {
    auto [blocks, dense] = random_twin(random, 3, 6, pairs, form);
    EXPECT_THROW(blocks.log_determinant(), NumericalError);
    const auto expected = [](const Eigen::MatrixXd& matrix) {
      return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix)
          .eigenvalues()
          .array()
          .log()
          .sum();
    };
    ASSERT_TRUE(blocks.factorise());
    EXPECT_NEAR(blocks.log_determinant(), expected(dense), 1e-11);
    const Eigen::VectorXd damping = Eigen::VectorXd::LinSpaced(18, 1.0, 18.0);
    ASSERT_TRUE(blocks.factorise(damping));
    EXPECT_NEAR(blocks.log_determinant(), expected(dense + Eigen::MatrixXd(damping.asDiagonal())),
                1e-11);
  }
}

// A column of L with k entries costs k^2, additions and multiplications counted.
TEST(BlockCholesky, TellsWhatAFactorisationTakes) {
  Random random(9);
  const auto sum_of_squares = [](double n) { return n * (n + 1.0) * (2.0 * n + 1.0) / 6.0; };
  for (const FactorForm form : {FactorForm::fastest, FactorForm::supernodal}) {
    const auto full = random_twin(random, 3, 3, Pairs{{0, 1}, {1, 2}, {0, 2}}, form).blocks;
    EXPECT_EQ(full.flops(), sum_of_squares(9));
    const auto apart = random_twin(random, 3, 4, Pairs{}, form).blocks;
    EXPECT_EQ(apart.flops(), 4.0 * sum_of_squares(3));
  }
}

TEST(BlockCholesky, Empty) {
  BlockCholesky blocks(3, 0, {});
  EXPECT_TRUE(blocks.factorise());
  EXPECT_EQ(blocks.log_determinant(), 0.0);
  EXPECT_EQ(blocks.flops(), 0.0);
  EXPECT_EQ(blocks.solve(Eigen::VectorXd()).size(), 0);
}

}  // namespace
}  // namespace isotherm::spectral
