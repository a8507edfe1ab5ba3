#include "sparse/inverse/half_solve.hpp"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "isotherm/base/random.hpp"
#include "sparse/inverse/pair_plan.hpp"

namespace isotherm::spectral::detail {
namespace {

using Pairs = std::vector<std::pair<Index, Index>>;

constexpr int kDof = 3;
constexpr double kDiagonal = 30.0;  // enough where every two blocks are joined

// A grid, whose elimination tree branches, in place of a larger map.
Pairs grid(Index side) {
  Pairs pairs;
  for (Index row = 0; row < side; ++row) {
    for (Index column = 0; column < side; ++column) {
      const Index at = row * side + column;
      if (column + 1 < side) pairs.emplace_back(at, at + 1);
      if (row + 1 < side) pairs.emplace_back(at, at + side);
    }
  }
  return pairs;
}

BlockCholesky factor_of(const Pairs& pairs, Index count, Eigen::MatrixXd& dense) {
  Random random(6);
  BlockCholesky blocks(kDof, count, pairs, FactorForm::supernodal);
  dense = kDiagonal * Eigen::MatrixXd::Identity(count * kDof, count * kDof);
  for (Index k = 0; k < count; ++k) {
    blocks.add_diagonal(k, (kDiagonal * Eigen::Matrix3d::Identity()).eval());
  }
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    Eigen::Matrix3d block;
    for (int e = 0; e < block.size(); ++e) block(e) = 0.5 * random.normal();
    const auto [a, b] = pairs[k];
    blocks.add_pair(k, block);
    dense.block<kDof, kDof>(a * kDof, b * kDof) += block;
    dense.block<kDof, kDof>(b * kDof, a * kDof) += block.transpose();
  }
  EXPECT_TRUE(blocks.factorise());
  return blocks;
}

// Z_ab = sum of (L^-1)_ka' (L^-1)_kb over all k, front by front.
Eigen::MatrixXd inverse_of(const FrontTree& tree, Eigen::Index most_entries, int threads) {
  const Eigen::Index size = Eigen::Index{tree.block_count()} * kDof;
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(size, size);
  for (Index front = 0; front < tree.front_count(); ++front) {
    std::vector<Index> below;
    for (Index block = 0; block < tree.block_count(); ++block) {
      if (tree.meeting(tree.front_of(block), front) == front) below.push_back(block);
    }
    std::vector<std::pair<Index, Index>> pairs;
    for (const Index a : below) {
      for (const Index b : below) pairs.emplace_back(a, b);
    }
    const auto products = HalfSolve<kDof>(tree, front, pairs, most_entries).products(threads);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const auto [a, b] = pairs[k];
      inverse.block<kDof, kDof>(a * kDof, b * kDof) += products[k];
    }
  }
  return inverse;
}

void expect_inverse(const Pairs& pairs, Index count, Eigen::Index most_entries) {
  Eigen::MatrixXd dense;
  const BlockCholesky blocks = factor_of(pairs, count, dense);
  const FrontTree tree(blocks);
  const Eigen::MatrixXd inverse = inverse_of(tree, most_entries, 1);
  EXPECT_LT((inverse - dense.inverse()).norm(), 1e-12);
  EXPECT_EQ(inverse, inverse_of(tree, most_entries, 2));
}

TEST(HalfSolve, RowsMultiplyToTheInverse) {
  for (const Index side : {1, 4, 9}) expect_inverse(grid(side), side * side, 1 << 20);
}

TEST(HalfSolve, RowsMayComeInSlabs) { expect_inverse(grid(9), 81, 0); }

// More than are solved for at once: one front, of all.
TEST(HalfSolve, SlabsMayBeMany) {
  constexpr Index kCount = 60;
  Pairs pairs;
  for (Index a = 0; a < kCount; ++a) {
    for (Index b = a + 1; b < kCount; ++b) pairs.emplace_back(a, b);
  }
  expect_inverse(pairs, kCount, 0);
}

TEST(PairPlan, HalfSolvesWhereManyPairsMeet) {
  const Index side = 12;
  const Index count = side * side;
  Eigen::MatrixXd dense;
  const BlockCholesky blocks = factor_of(grid(side), count, dense);
  const FrontTree tree(blocks);
  const Index root = tree.front_count() - 1;
  Pairs across;
  for (Index a = 0; a < count; ++a) {
    for (Index b = 0; b < count; ++b) {
      if (tree.meeting(tree.front_of(a), tree.front_of(b)) == root) across.emplace_back(a, b);
    }
  }
  const PairPlan many(tree, across);
  EXPECT_TRUE(many.half_solved(root));
  std::size_t held = 0;
  for (Index f = 0; f < tree.front_count(); ++f) held += many.held_by(f).size();
  EXPECT_GT(held, 0u);
  EXPECT_EQ(many.meeting_at(root).size() + held, across.size());

  const PairPlan one(tree, std::span(across).first(1));
  EXPECT_FALSE(one.half_solved(root));
  for (Index f = 0; f < tree.front_count(); ++f) {
    const bool leads = tree.meeting(f, tree.front_of(across[0].first)) == f ||
                       tree.meeting(f, tree.front_of(across[0].second)) == f;
    EXPECT_EQ(one.wanted(f), leads);
  }
}

TEST(PairPlan, FrontsHoldThePairsOfThePattern) {
  const Index side = 12;
  const Pairs neighbours = grid(side);
  Eigen::MatrixXd dense;
  const BlockCholesky blocks = factor_of(neighbours, side * side, dense);
  const FrontTree tree(blocks);
  const PairPlan plan(tree, neighbours);
  std::size_t held = 0;
  for (Index f = 0; f < tree.front_count(); ++f) {
    EXPECT_TRUE(plan.meeting_at(f).empty());
    for (const std::size_t k : plan.held_by(f)) {
      const auto [a, b] = neighbours[k];
      EXPECT_TRUE(tree.front_of(a) == f || tree.front_of(b) == f);
      EXPECT_EQ(tree.row(f, tree.place(f, a)), tree.position(a));
      EXPECT_EQ(tree.row(f, tree.place(f, b)), tree.position(b));
    }
    held += plan.held_by(f).size();
  }
  EXPECT_EQ(held, neighbours.size());
  EXPECT_EQ(tree.place(0, tree.block(tree.front_count() - 1, 0)), FrontTree::kNone);
}

TEST(PairPlan, HalfSolvesAParentWithItsChild) {
  const Index count = 144;
  Eigen::MatrixXd dense;
  const BlockCholesky blocks = factor_of(grid(12), count, dense);
  const FrontTree tree(blocks);
  Pairs all;
  for (Index a = 0; a < count; ++a) {
    for (Index b = 0; b < count; ++b) all.emplace_back(a, b);
  }
  const PairPlan plan(tree, all);
  for (Index f = 0; f < tree.front_count(); ++f) {
    if (!plan.half_solved(f) || tree.parent(f) == FrontTree::kNone) continue;
    EXPECT_TRUE(plan.half_solved(tree.parent(f)));
  }
}

}  // namespace
}  // namespace isotherm::spectral::detail
