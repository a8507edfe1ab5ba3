#include "sparse/dense_kernels.hpp"

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
}

namespace isotherm::spectral::detail {
namespace {

template <class Function, class View, class ConstView, class Scalar>
void multiply(Function gemm, const char* transpose_a, View& C, Scalar scale, const ConstView& A,
              const ConstView& B) {
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
  multiply(dgemm_, "N", C, scale, A, B);
}

void add_product(ComplexView C, double scale, const ConstComplexView& A,
                 const ConstComplexView& B) {
  multiply(zgemm_, "N", C, std::complex<double>(scale), A, B);
}

void add_transposed_product(DenseView C, double scale, const ConstDenseView& A,
                            const ConstDenseView& B) {
  multiply(dgemm_, "T", C, scale, A, B);
}

void add_transposed_product(ComplexView C, double scale, const ConstComplexView& A,
                            const ConstComplexView& B) {
  multiply(zgemm_, "T", C, std::complex<double>(scale), A, B);
}

namespace {

void solve_triangle(const char* side, const ConstDenseView& L, DenseView X) {
  if (X.size() == 0) return;
  const int rows = static_cast<int>(X.rows());
  const int columns = static_cast<int>(X.cols());
  const int ldl = static_cast<int>(L.outerStride());
  const int ldx = static_cast<int>(X.outerStride());
  const double one = 1.0;
  dtrsm_(side, "L", "N", "N", &rows, &columns, &one, L.data(), &ldl, X.data(), &ldx);
}

}  // namespace

void solve_lower(const ConstDenseView& L, DenseView X) { solve_triangle("L", L, X); }

void solve_lower_from_right(const ConstDenseView& L, DenseView X) { solve_triangle("R", L, X); }

}  // namespace isotherm::spectral::detail
