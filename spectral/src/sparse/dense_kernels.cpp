#include "sparse/dense_kernels.hpp"

#include <algorithm>

extern "C" {
void dgemm_(const char* trans_a, const char* trans_b, const int* rows, const int* columns,
            const int* inner, const double* alpha, const double* a, const int* lda, const double* b,
            const int* ldb, const double* beta, double* c, const int* ldc);
void zgemm_(const char* trans_a, const char* trans_b, const int* rows, const int* columns,
            const int* inner, const std::complex<double>* alpha, const std::complex<double>* a,
            const int* lda, const std::complex<double>* b, const int* ldb,
            const std::complex<double>* beta, std::complex<double>* c, const int* ldc);
void dtrsm_(const char* side, const char* triangle, const char* trans, const char* diagonal,
            const int* rows, const int* columns, const double* alpha, const double* a,
            const int* lda, double* b, const int* ldb);
void dtrmm_(const char* side, const char* triangle, const char* trans, const char* diagonal,
            const int* rows, const int* columns, const double* alpha, const double* a,
            const int* lda, double* b, const int* ldb);
void dsyrk_(const char* triangle, const char* trans, const int* order, const int* inner,
            const double* alpha, const double* a, const int* lda, const double* beta, double* c,
            const int* ldc);
}

namespace isotherm::spectral::detail {
namespace {

template <class Function, class View, class ConstView, class Scalar>
void add_scaled_product(Function gemm, const char* transpose_a, View& C, Scalar scale,
                        const ConstView& A, const ConstView& B) {
  if (C.size() == 0 || B.rows() == 0) return;
  const int rows = static_cast<int>(C.rows());
  const int columns = static_cast<int>(C.cols());
  const int inner = static_cast<int>(B.rows());
  const int lda = static_cast<int>(A.outerStride());
  const int ldb = static_cast<int>(B.outerStride());
  const int ldc = static_cast<int>(C.outerStride());
  const Scalar one = 1.0;
  gemm(transpose_a, "N", &rows, &columns, &inner, &scale, A.data(), &lda, B.data(), &ldb, &one,
       C.data(), &ldc);
}

}  // namespace

void add_product(DenseView C, double scale, const ConstDenseView& A, const ConstDenseView& B) {
  add_scaled_product(dgemm_, "N", C, scale, A, B);
}

void add_product(ComplexView C, double scale, const ConstComplexView& A,
                 const ConstComplexView& B) {
  add_scaled_product(zgemm_, "N", C, std::complex<double>(scale), A, B);
}

void add_transposed_product(DenseView C, double scale, const ConstDenseView& A,
                            const ConstDenseView& B) {
  add_scaled_product(dgemm_, "T", C, scale, A, B);
}

void add_transposed_product(ComplexView C, double scale, const ConstComplexView& A,
                            const ConstComplexView& B) {
  add_scaled_product(zgemm_, "T", C, std::complex<double>(scale), A, B);
}

namespace {

constexpr Eigen::Index kSmall = 48;   // order up to which a triangle is not divided
constexpr Eigen::Index kPanel = 128;  // columns of a symmetric product formed together

template <class Function>
void apply_triangle(Function function, const char* side, const char* trans, double scale,
                    const ConstDenseView& L, DenseView X) {
  if (X.size() == 0) return;
  const int rows = static_cast<int>(X.rows());
  const int columns = static_cast<int>(X.cols());
  const int ldl = static_cast<int>(L.outerStride());
  const int ldx = static_cast<int>(X.outerStride());
  function(side, "L", trans, "N", &rows, &columns, &scale, L.data(), &ldl, X.data(), &ldx);
}

// Lower triangle of C += A' A.
void add_gram(DenseView C, const ConstDenseView& A) {
  if (C.size() == 0 || A.rows() == 0) return;
  const int order = static_cast<int>(C.rows());
  const int inner = static_cast<int>(A.rows());
  const int lda = static_cast<int>(A.outerStride());
  const int ldc = static_cast<int>(C.outerStride());
  const double one = 1.0;
  dsyrk_("L", "T", &order, &inner, &one, A.data(), &lda, &one, C.data(), &ldc);
}

// L = L^-1.
void invert_lower(DenseView L) {
  const Eigen::Index n = L.rows();
  if (n <= kSmall) {
    Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(n, n);
    solve_lower(L, inverse);
    L.triangularView<Eigen::Lower>() = inverse;
    return;
  }
  const Eigen::Index half = n / 2;
  invert_lower(L.topLeftCorner(half, half));
  invert_lower(L.bottomRightCorner(n - half, n - half));
  DenseView corner = L.bottomLeftCorner(n - half, half);
  apply_triangle(dtrmm_, "R", "N", -1.0, L.topLeftCorner(half, half), corner);
  apply_triangle(dtrmm_, "L", "N", 1.0, L.bottomRightCorner(n - half, n - half), corner);
}

// Lower triangle of L' L, in the place of L.
void square_lower(DenseView L) {
  const Eigen::Index n = L.rows();
  if (n <= kSmall) {
    const Eigen::MatrixXd root = L.triangularView<Eigen::Lower>();
    L.triangularView<Eigen::Lower>().setZero();
    add_gram(L, root);
    return;
  }
  const Eigen::Index half = n / 2;
  DenseView corner = L.bottomLeftCorner(n - half, half);
  square_lower(L.topLeftCorner(half, half));
  add_gram(L.topLeftCorner(half, half), corner);
  apply_triangle(dtrmm_, "L", "T", 1.0, L.bottomRightCorner(n - half, n - half), corner);
  square_lower(L.bottomRightCorner(n - half, n - half));
}

template <class View>
void copy_to_upper(View& C) {
  for (Eigen::Index k = 0; k + 1 < C.cols(); ++k) {
    C.row(k).tail(C.cols() - k - 1) = C.col(k).tail(C.rows() - k - 1).transpose();
  }
}

template <class View, class ConstView>
void multiply_symmetric(View& C, double scale, const ConstView& A, const ConstView& B) {
  for (Eigen::Index at = 0; at < C.cols(); at += kPanel) {
    const Eigen::Index columns = std::min(kPanel, C.cols() - at);
    add_transposed_product(C.block(at, at, C.rows() - at, columns), scale,
                           A.rightCols(C.rows() - at), B.middleCols(at, columns));
  }
  copy_to_upper(C);
}

}  // namespace

void solve_lower(const ConstDenseView& L, DenseView X) {
  apply_triangle(dtrsm_, "L", "N", 1.0, L, X);
}

void solve_lower_from_right(const ConstDenseView& L, DenseView X) {
  apply_triangle(dtrsm_, "R", "N", 1.0, L, X);
}

void invert_from_factor(DenseView L) {
  invert_lower(L);
  square_lower(L);
  copy_to_upper(L);
}

void add_symmetric_product(DenseView C, double scale, const ConstDenseView& A,
                           const ConstDenseView& B) {
  multiply_symmetric(C, scale, A, B);
}

void add_symmetric_product(ComplexView C, double scale, const ConstComplexView& A,
                           const ConstComplexView& B) {
  multiply_symmetric(C, scale, A, B);
}

}  // namespace isotherm::spectral::detail
