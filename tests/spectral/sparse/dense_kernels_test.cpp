#include "sparse/dense_kernels.hpp"

#include <atomic>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "isotherm/base/parallel.hpp"
#include "isotherm/base/random.hpp"

namespace isotherm::spectral::detail {
namespace {

template <class Matrix>
Matrix random_matrix(Random& random, Eigen::Index rows, Eigen::Index columns) {
  return Matrix::NullaryExpr(rows, columns, [&] { return random.normal(); });
}

// Around the order from which triangles are divided.
TEST(DenseKernels, InverseFromAFactorIsThatOfTheMatrix) {
  Random random(1);
  for (const Eigen::Index n : {0, 1, 2, 47, 48, 49, 97, 200}) {
    const auto root = random_matrix<Eigen::MatrixXd>(random, n, n);
    const Eigen::MatrixXd matrix = root * root.transpose() + Eigen::MatrixXd::Identity(n, n);
    Eigen::MatrixXd inverse = Eigen::LLT<Eigen::MatrixXd>(matrix).matrixL();
    inverse.triangularView<Eigen::StrictlyUpper>().setConstant(7.0);  // is not looked at
    invert_from_factor(inverse);
    EXPECT_LT((inverse * matrix - Eigen::MatrixXd::Identity(n, n)).norm(),
              1e-9 * static_cast<double>(1 + n))
        << n;
    EXPECT_EQ(inverse, Eigen::MatrixXd(inverse.transpose())) << n;
  }
}

template <class Matrix>
void expect_symmetric_product(Eigen::Index n, Eigen::Index inner) {
  Random random(2);
  const auto a = random_matrix<Matrix>(random, inner, n);
  const auto core = random_matrix<Matrix>(random, inner, inner);
  const Matrix b = (core + core.transpose()) * a;
  const auto c = random_matrix<Matrix>(random, n, n);
  Matrix sum = c + c.transpose();
  const Matrix expected = sum - 2.0 * a.transpose() * b;
  add_symmetric_product(sum, -2.0, a, b);
  EXPECT_LT((sum - expected).norm(), 1e-12 * (1.0 + expected.norm())) << n << " " << inner;
  EXPECT_EQ(sum, Matrix(sum.transpose()));
}

TEST(DenseKernels, SymmetricProductIsTheGeneralOne) {
  for (const Eigen::Index n : {0, 1, 127, 128, 129, 300}) {
    for (const Eigen::Index inner : {0, 1, 50}) {
      expect_symmetric_product<Eigen::MatrixXd>(n, inner);
      expect_symmetric_product<Eigen::MatrixXcd>(n, inner);
    }
  }
}

// A BLAS whose calls share a buffer gives one in a hundred of these products wrong.
TEST(DenseKernels, ProductsOnSeveralThreadsAreThoseOnOne) {
  Random random(3);
  constexpr std::int64_t kCount = 20000;
  std::vector<Eigen::MatrixXd> factors;
  for (int k = 0; k < 7; ++k) factors.push_back(random_matrix<Eigen::MatrixXd>(random, 24, 24));
  const auto product = [&factors](std::int64_t k) {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(24, 24);
    add_transposed_product(result, 1.0, factors[static_cast<std::size_t>(k % 7)],
                           factors[static_cast<std::size_t>(k * k % 7)]);
    return result;
  };
  std::vector<Eigen::MatrixXd> alone;
  for (std::int64_t k = 0; k < 7; ++k) alone.push_back(product(k));
  std::atomic<int> wrong = 0;
  parallel_for(kCount, 0, {}, "products", [&](std::int64_t k) {
    if (product(k) != alone[static_cast<std::size_t>(k % 7)]) ++wrong;
  });
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace isotherm::spectral::detail
