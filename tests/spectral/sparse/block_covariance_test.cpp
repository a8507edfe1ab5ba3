#include "isotherm/spectral/sparse/block_covariance.hpp"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "isotherm/base/error.hpp"
#include "isotherm/base/random.hpp"
#include "isotherm/spectral/sparse/branch_covariance.hpp"
#include "sparse/block_order.hpp"

namespace isotherm::spectral {
namespace {

using Pairs = std::vector<std::pair<Index, Index>>;

// A ring of blocks with some chords, and the inverse of the same matrix stored dense.
template <int Dof>
struct System {
  BlockCholesky blocks;
  Eigen::MatrixXd inverse;
};

template <int Dof>
System<Dof> random_system(Random& random, Index count, const Pairs& pairs) {
  using Block = typename PairCovariance<Dof>::Block;
  BlockCholesky blocks(Dof, count, pairs, FactorForm::supernodal);
  Eigen::MatrixXd dense = 20.0 * Eigen::MatrixXd::Identity(count * Dof, count * Dof);
  for (Index k = 0; k < count; ++k) blocks.add_diagonal(k, (20.0 * Block::Identity()).eval());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    Block block;
    for (int e = 0; e < block.size(); ++e) block(e) = 0.4 * random.normal();
    const auto [a, b] = pairs[k];
    blocks.add_pair(k, block);
    dense.template block<Dof, Dof>(a * Dof, b * Dof) += block;
    dense.template block<Dof, Dof>(b * Dof, a * Dof) += block.transpose();
  }
  EXPECT_TRUE(blocks.factorise());
  return {std::move(blocks), dense.inverse()};
}

Pairs ring_with_chords(Random& random, Index count, int chords) {
  Pairs pairs;
  for (Index k = 0; k < count; ++k) pairs.emplace_back(k, (k + 1) % count);
  for (int k = 0; k < chords; ++k) {
    const auto a = static_cast<Index>(random.index(count));
    const auto b = static_cast<Index>(random.index(count));
    if (a != b) pairs.emplace_back(a, b);
  }
  return pairs;
}

constexpr auto kSupernodal = FactorForm::supernodal;

Pairs all_pairs(Index count) {
  Pairs pairs;
  for (Index a = 0; a < count; ++a) {
    for (Index b = 0; b < count; ++b) pairs.emplace_back(a, b);
  }
  return pairs;
}

template <int Dof>
void expect_all_right(const System<Dof>& system, const Pairs& pairs) {
  const auto answers = pair_covariances<Dof>(system.blocks, pairs);
  ASSERT_EQ(answers.size(), pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [a, b] = pairs[k];
    const auto block = [&](Index row, Index column) {
      return system.inverse.template block<Dof, Dof>(row * Dof, column * Dof);
    };
    EXPECT_LT((answers[k].first - block(a, a)).norm(), 1e-12) << a;
    EXPECT_LT((answers[k].second - block(b, b)).norm(), 1e-12) << b;
    EXPECT_LT((answers[k].cross - block(a, b)).norm(), 1e-12) << a << " " << b;
  }
}

template <class Size>
class PairCovarianceOf : public testing::Test {};
using Sizes = testing::Types<std::integral_constant<int, 3>, std::integral_constant<int, 6>>;
TYPED_TEST_SUITE(PairCovarianceOf, Sizes);

TYPED_TEST(PairCovarianceOf, AreBlocksOfTheDenseInverse) {
  constexpr int kDof = TypeParam::value;
  Random random(3);
  for (const Index count : {3, 10, 40}) {
    for (const int chords : {0, 8, 60}) {
      const auto pairs = ring_with_chords(random, count, chords);
      const auto system = random_system<kDof>(random, count, pairs);
      expect_all_right<kDof>(system, all_pairs(count));
      expect_all_right<kDof>(system, {{0, count - 1}, {1, 1}});
    }
  }
}

TYPED_TEST(PairCovarianceOf, BetweenSeparatePartsAreZero) {
  constexpr int kDof = TypeParam::value;
  Random random(4);
  const auto system = random_system<kDof>(random, 7, {{0, 1}, {1, 2}, {3, 4}, {4, 5}});
  expect_all_right<kDof>(system, all_pairs(7));
}

TYPED_TEST(PairCovarianceOf, RowsThatAreNotThereAreZero) {
  constexpr int kDof = TypeParam::value;
  Random random(5);
  const auto system = random_system<kDof>(random, 4, {{0, 1}, {1, 2}, {2, 3}});
  const Pairs pairs = {{-1, 2}, {1, -1}, {-1, -1}};
  const auto answers = pair_covariances<kDof>(system.blocks, pairs);
  EXPECT_EQ(answers[0].first.norm(), 0.0);
  EXPECT_LT(
      (answers[0].second - system.inverse.template block<kDof, kDof>(2 * kDof, 2 * kDof)).norm(),
      1e-12);
  EXPECT_GT(answers[1].first.norm(), 0.0);
  for (const auto& answer : answers) EXPECT_EQ(answer.cross.norm(), 0.0);
  EXPECT_EQ(answers[2].second.norm(), 0.0);
}

TYPED_TEST(PairCovarianceOf, AreThoseOfOneFunctionAtATime) {
  constexpr int kDof = TypeParam::value;
  using Branches = BranchCovariance<kDof>;
  Random random(6);
  const auto system =
      random_system<kDof>(random, 30, {{0, 1}, {1, 2}, {2, 3}, {3, 9}, {9, 20}, {20, 0}, {5, 6}});
  const Branches branches(system.blocks);
  for (const auto& [a, b] : Pairs{{0, 9}, {20, 20}, {5, 2}, {6, -1}, {-1, -1}}) {
    std::vector<typename Branches::Term> terms(2);
    terms[0].row = a;
    terms[1].row = b;
    Eigen::MatrixXd G = Eigen::MatrixXd::Zero(30 * kDof, kDof);
    for (auto& term : terms) {
      for (int e = 0; e < term.G.size(); ++e) term.G(e) = random.normal();
      if (term.row >= 0) G.template middleRows<kDof>(term.row * kDof) += term.G;
    }
    const auto covariance = branches.of(terms);
    EXPECT_LT((covariance - G.transpose() * system.inverse * G).norm(), 1e-12) << a << " " << b;
  }
}

TEST(PairCovariance, NeedsASupernodalFactor) {
  const Pairs pairs = {{0, 1}};
  BlockCholesky blocks(3, 2, pairs);
  blocks.add_diagonal(0, Eigen::Matrix3d::Identity().eval());
  blocks.add_diagonal(1, Eigen::Matrix3d::Identity().eval());
  ASSERT_TRUE(blocks.factorise());
  EXPECT_THROW(pair_covariances<3>(blocks, pairs), InvalidArgument);
  EXPECT_THROW(BranchCovariance<3>{blocks}, InvalidArgument);
  EXPECT_TRUE(pair_covariances<3>(blocks, {}).empty());

  const BlockCholesky without_factor(3, 2, pairs, FactorForm::supernodal);
  EXPECT_THROW(pair_covariances<3>(without_factor, pairs), NumericalError);
}

TEST(ChainElimination, TakesAChainApartInFewRounds) {
  Pairs chain;
  for (Index k = 0; k + 1 < 100; ++k) chain.emplace_back(k + 1, k);
  const auto result = detail::eliminate_chains(100, chain);
  EXPECT_EQ(result.order.size(), 100u);
  EXPECT_TRUE(result.core.empty());
  EXPECT_TRUE(result.pairs.empty());
}

TEST(ChainElimination, LeavesTheGraphBetweenCrossings) {
  // Four crossings, every two of them joined by a chain of five blocks.
  Pairs pairs;
  Index next = 4;
  for (Index a = 0; a < 4; ++a) {
    for (Index b = a + 1; b < 4; ++b) {
      Index at = a;
      for (int k = 0; k < 5; ++k) {
        pairs.emplace_back(at, next);
        at = next++;
      }
      pairs.emplace_back(at, b);
      pairs.emplace_back(b, at);
    }
  }
  const auto result = detail::eliminate_chains(next, pairs);
  EXPECT_EQ(result.core, (std::vector<Index>{0, 1, 2, 3}));
  EXPECT_EQ(result.pairs, (Pairs{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}));
  EXPECT_EQ(result.order.size(), static_cast<std::size_t>(next - 4));
}

TEST(ChainElimination, DegenerateGraphs) {
  EXPECT_TRUE(detail::eliminate_chains(0, {}).order.empty());
  EXPECT_EQ(detail::eliminate_chains(3, {}).order, (std::vector<Index>{0, 1, 2}));
}

}  // namespace
}  // namespace isotherm::spectral
