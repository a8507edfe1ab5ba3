#pragma once

#include <complex>

#include <Eigen/Core>

namespace isotherm::spectral::detail {

/// Dense products by the BLAS that CHOLMOD uses as well: several times as fast as
/// Eigen's on machines with wide vectors, since the target is chosen when they run.
using DenseView = Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
using ConstDenseView = Eigen::Ref<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
using ComplexView = Eigen::Ref<Eigen::MatrixXcd, 0, Eigen::OuterStride<>>;
using ConstComplexView = Eigen::Ref<const Eigen::MatrixXcd, 0, Eigen::OuterStride<>>;

/// C += scale * A B
void add_product(DenseView C, double scale, const ConstDenseView& A, const ConstDenseView& B);
void add_product(ComplexView C, double scale, const ConstComplexView& A, const ConstComplexView& B);

/// C += scale * A' B, where A' is not conjugated.
void add_transposed_product(DenseView C, double scale, const ConstDenseView& A,
                            const ConstDenseView& B);
void add_transposed_product(ComplexView C, double scale, const ConstComplexView& A,
                            const ConstComplexView& B);

/// C += scale * A' B where that and C are symmetric: half the work of the general product.
void add_symmetric_product(DenseView C, double scale, const ConstDenseView& A,
                           const ConstDenseView& B);

void add_symmetric_product(ComplexView C, double scale, const ConstComplexView& A,
                           const ConstComplexView& B);

/// (L L')^-1, in the place of L, of which the lower triangle is used. 2/3 n^3 operations.
void invert_from_factor(DenseView L);

/// X = L^-1 X, of which the lower triangle of L is used.
void solve_lower(const ConstDenseView& L, DenseView X);

/// X = X L^-1, of which the lower triangle of L is used.
void solve_lower_from_right(const ConstDenseView& L, DenseView X);

}  // namespace isotherm::spectral::detail
