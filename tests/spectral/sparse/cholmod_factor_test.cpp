#include "sparse/cholmod_factor.hpp"

#include <filesystem>
#include <iterator>
#include <thread>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "isotherm/base/error.hpp"
#include "isotherm/base/random.hpp"
#include "sparse/find_supernodes.hpp"

namespace isotherm::spectral::detail {
namespace {

// Lower triangle of a positive definite matrix on a grid with some far links.
SparseMatrix random_grid(Index side) {
  Random random(9);
  const Index size = side * side;
  std::vector<Eigen::Triplet<double, Index>> entries;
  for (Index v = 0; v < size; ++v) {
    entries.emplace_back(v, v, 8.0 + random.uniform(0.0, 1.0));
    if ((v + 1) % side != 0) entries.emplace_back(v + 1, v, random.uniform(-1.0, 1.0));
    if (v + side < size) entries.emplace_back(v + side, v, random.uniform(-1.0, 1.0));
    if (v % 17 == 0 && v + 5 * side < size) entries.emplace_back(v + 5 * side, v, 0.5);
  }
  SparseMatrix lower(size, size);
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

Eigen::MatrixXd dense(const SparseMatrix& lower) {
  return Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
}

Eigen::MatrixXd permuted(const Eigen::MatrixXd& matrix, std::span<const Index> order) {
  const std::vector<Index> rows(order.begin(), order.end());
  return matrix(rows, rows);
}

TEST(CholmodFactor, SupernodesHoldTheFactor) {
  const SparseMatrix lower = random_grid(14);
  const CholmodFactor factor(lower, FactorKind::supernodal);
  const Supernodes supernodes = factor.supernodes();
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(lower.rows(), lower.rows());
  for (std::size_t s = 0; s + 1 < supernodes.first_column.size(); ++s) {
    const Index height = supernodes.row_start[s + 1] - supernodes.row_start[s];
    for (Index c = supernodes.first_column[s]; c < supernodes.first_column[s + 1]; ++c) {
      const Index k = c - supernodes.first_column[s];
      for (Index at = k; at < height; ++at) {
        L(supernodes.rows[supernodes.row_start[s] + at], c) =
            supernodes.values[supernodes.value_start[s] + k * height + at];
      }
    }
  }
  EXPECT_LT((L * L.transpose() - permuted(dense(lower), supernodes.order)).norm(), 1e-11);
}

TEST(CholmodFactor, SolvesAndCountsAsADenseSolverDoes) {
  const SparseMatrix lower = random_grid(9);
  const Eigen::MatrixXd whole = dense(lower);
  const Eigen::MatrixXd rhs = Eigen::MatrixXd::Random(whole.rows(), 3);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(whole);
  for (const auto kind : {FactorKind::positive_definite, FactorKind::known_definite,
                          FactorKind::supernodal, FactorKind::symmetric}) {
    CholmodFactor factor(lower, kind);
    EXPECT_LT((whole * factor.solve(rhs) - rhs).norm(), 1e-11);
    Eigen::VectorXd x = rhs.col(0);
    factor.solve(x.data(), x.data());
    EXPECT_LT((whole * x - rhs.col(0)).norm(), 1e-11);
    EXPECT_NEAR(factor.log_determinant(), eigen.eigenvalues().array().log().sum(), 1e-10);
  }
  SparseMatrix shifted = lower;
  for (Index v = 0; v < shifted.rows(); ++v) shifted.coeffRef(v, v) -= 8.5;
  const Index below = static_cast<Index>((eigen.eigenvalues().array() < 8.5).count());
  EXPECT_EQ(CholmodFactor(shifted, FactorKind::symmetric).negative_pivots(), below);
  EXPECT_THROW(CholmodFactor(shifted, FactorKind::supernodal), NumericalError);
}

// A thread that CHOLMOD's OpenMP begins stays until the one that asked for it ends.
TEST(CholmodFactor, BeginsNoThreads) {
  const std::filesystem::path tasks = "/proc/self/task";
  if (!std::filesystem::exists(tasks)) GTEST_SKIP() << "threads are counted in " << tasks;
  const auto count = [&tasks] {
    return std::distance(std::filesystem::directory_iterator(tasks), {});
  };
  std::ptrdiff_t begun = 0;
  std::thread([&] {
    const auto before = count();
    const CholmodFactor factor(random_grid(70), FactorKind::supernodal);
    begun = count() - before;
  }).join();
  EXPECT_EQ(begun, 0);
}

// Every entry of L has its place, and joining adds few others.
TEST(FindSupernodes, CoverTheFactor) {
  const SparseMatrix lower = random_grid(20);
  const auto order = fill_reducing_order(lower_triangle(lower));
  const SupernodeLayout layout = find_supernodes(lower_triangle(lower), order);
  const Eigen::MatrixXd L = permuted(dense(lower), order).llt().matrixL();
  Eigen::MatrixXi covered = Eigen::MatrixXi::Zero(L.rows(), L.cols());
  for (std::size_t s = 0; s + 1 < layout.first_column.size(); ++s) {
    const auto rows =
        std::span(layout.rows)
            .subspan(layout.row_start[s], layout.row_start[s + 1] - layout.row_start[s]);
    EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
    for (Index c = layout.first_column[s]; c < layout.first_column[s + 1]; ++c) {
      EXPECT_EQ(rows[c - layout.first_column[s]], c) << "own columns come first";
      for (const Index row : rows) covered(row, c) += row >= c;
    }
  }
  EXPECT_EQ(layout.first_column.back(), lower.rows());
  EXPECT_EQ(covered.maxCoeff(), 1);
  const auto entries = (L.array() != 0.0).count();
  EXPECT_EQ((L.array() != 0.0 && covered.array() == 0).count(), 0);
  EXPECT_LT(covered.sum(), 1.5 * static_cast<double>(entries));
  EXPECT_LT(layout.first_column.size(), static_cast<std::size_t>(lower.rows()) / 2);
}

TEST(FindSupernodes, OneForADenseMatrix) {
  const Eigen::MatrixXd full = Eigen::MatrixXd::Ones(7, 7);
  const SparseMatrix lower = full.triangularView<Eigen::Lower>().toDenseMatrix().sparseView();
  const std::vector<Index> order = {0, 1, 2, 3, 4, 5, 6};
  const SupernodeLayout layout = find_supernodes(lower_triangle(lower), order);
  EXPECT_EQ(layout.first_column, (std::vector<Index>{0, 7}));
  EXPECT_EQ(layout.rows, order);
}

}  // namespace
}  // namespace isotherm::spectral::detail
