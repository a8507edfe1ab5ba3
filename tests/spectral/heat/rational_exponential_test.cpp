#include "heat/rational_exponential_table.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "heat/tridiagonal_exponential.hpp"
#include "isotherm/base/random.hpp"

namespace isotherm::spectral::detail {
namespace {

TEST(RationalExponential, ErrorsHoldOnTheWholeHalfLine) {
  double previous = 1.0;
  for (const auto& rational : kRationalExponentials) {
    EXPECT_LT(rational.error, previous);
    previous = rational.error;
    for (double x = 0.0; x < 1e12; x = x == 0.0 ? 1e-9 : x * 1.003) {
      double value = rational.constant;
      for (const auto& term : rational.terms) {
        const double part = (term.residue / (x + term.shift)).real();
        value += is_real(term) ? part : 2.0 * part;
      }
      EXPECT_LE(std::abs(value - std::exp(-x)), rational.error) << "at " << x;
    }
  }
}

TEST(TridiagonalExponential, AgreesWithTheSpectrum) {
  Random random(61);
  for (const auto& rational : kRationalExponentials) {
    const TridiagonalExponential exponential(rational);
    for (const int size : {1, 2, 7, 40}) {
      // B'B with B bidiagonal is tridiagonal and positive semidefinite.
      Eigen::MatrixXd factor = Eigen::MatrixXd::Zero(size, size);
      for (int k = 0; k < size; ++k) {
        factor(k, k) = random.uniform(-2.0, 2.0);
        if (k + 1 < size) factor(k, k + 1) = random.uniform(-2.0, 2.0);
      }
      const Eigen::MatrixXd matrix = factor.transpose() * factor;
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
      const Eigen::VectorXd diagonal = matrix.diagonal();
      const Eigen::VectorXd off_diagonal = matrix.diagonal<1>();
      const auto as_span = [](const Eigen::VectorXd& v) {
        return std::span<const double>(v.data(), static_cast<std::size_t>(v.size()));
      };
      for (const double scale : {0.0, 0.01, 1.0, 300.0}) {
        const Eigen::ArrayXd first = solver.eigenvectors().row(0).transpose().array();
        const double exact = ((-scale * solver.eigenvalues().array()).exp() * first.square()).sum();
        EXPECT_NEAR(exponential(as_span(diagonal), as_span(off_diagonal), scale), exact,
                    exponential.error_bound(scale, solver.eigenvalues().maxCoeff()) + 1e-13);
      }
    }
  }
}

}  // namespace
}  // namespace isotherm::spectral::detail
