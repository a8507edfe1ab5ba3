#include "isotherm/spectral/sparse/inverse_entries.hpp"

#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "isotherm/base/error.hpp"
#include "isotherm/base/random.hpp"

namespace isotherm::spectral {
namespace {

TEST(InverseEntries, EqualThoseOfTheDenseInverse) {
  Random random(4);
  constexpr Index kSize = 40;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Identity(kSize, kSize) * 8.0;
  for (int k = 0; k < 60; ++k) {
    const auto i = static_cast<Index>(random.index(kSize));
    const auto j = static_cast<Index>(random.index(kSize));
    dense(i, j) = dense(j, i) = i == j ? 8.0 : random.uniform(-1.0, 1.0);
  }
  const SparseMatrix lower = dense.triangularView<Eigen::Lower>().toDenseMatrix().sparseView();
  std::vector<VertexPair> pairs = {{3, 3}};
  for (int k = 0; k < 50; ++k) {
    pairs.push_back(
        {static_cast<Index>(random.index(kSize)), static_cast<Index>(random.index(kSize))});
  }
  const auto found = inverse_entries(lower, pairs);
  const Eigen::MatrixXd inverse = dense.inverse();
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    EXPECT_NEAR(found.values[k], inverse(pairs[k].from, pairs[k].to), 1e-13);
  }
  EXPECT_LT(found.residual, 1e-12);
}

TEST(InverseEntries, NothingAskedAndBadRows) {
  SparseMatrix one(1, 1);
  one.insert(0, 0) = 4.0;
  EXPECT_TRUE(inverse_entries(one, {}).values.empty());
  EXPECT_TRUE(inverse_entries(SparseMatrix(0, 0), {}).values.empty());
  EXPECT_DOUBLE_EQ(inverse_entries(one, std::vector<VertexPair>{{0, 0}}).values[0], 0.25);
  EXPECT_THROW(inverse_entries(one, std::vector<VertexPair>{{0, 1}}), InvalidArgument);
}

}  // namespace
}  // namespace isotherm::spectral
