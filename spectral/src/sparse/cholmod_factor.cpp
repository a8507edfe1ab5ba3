#include "sparse/cholmod_factor.hpp"

#include <algorithm>

#include <cholmod.h>

#include "isotherm/base/error.hpp"
#include "sparse/cholmod_view.hpp"

namespace isotherm::spectral::detail {
struct CholmodFactor::Impl {
  cholmod_common common = {};
  cholmod_factor* factor = nullptr;
  cholmod_dense* solution = nullptr;
  cholmod_dense* work_y = nullptr;
  cholmod_dense* work_e = nullptr;

  Impl() {
    cholmod_start(&common);
    common.print = 0;
    common.error_handler = nullptr;
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    cholmod_free_dense(&solution, &common);
    cholmod_free_dense(&work_y, &common);
    cholmod_free_dense(&work_e, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
};

CholmodFactor::CholmodFactor(const SparseMatrix& matrix, FactorKind kind)
    : impl_(std::make_unique<Impl>()) {
  auto& common = impl_->common;
  if (kind == FactorKind::symmetric) {
    common.supernodal = CHOLMOD_SIMPLICIAL;
    common.final_ll = 0;
  }
  auto view = cholmod_lower_view(matrix);
  impl_->factor = cholmod_analyze(&view, &common);
  if (impl_->factor == nullptr) throw NumericalError("factorisation", "symbolic analysis failed");
  cholmod_factorize(&view, impl_->factor, &common);
  if (common.status != CHOLMOD_OK ||
      impl_->factor->minor != static_cast<std::size_t>(matrix.rows())) {
    throw NumericalError("factorisation", "a pivot broke down");
  }
}

CholmodFactor::~CholmodFactor() = default;
CholmodFactor::CholmodFactor(CholmodFactor&&) noexcept = default;

Index CholmodFactor::size() const noexcept { return static_cast<Index>(impl_->factor->n); }

void CholmodFactor::solve(const double* b, double* x) {
  cholmod_dense right = {};
  right.nrow = impl_->factor->n;
  right.ncol = 1;
  right.nzmax = right.nrow;
  right.d = right.nrow;
  right.x = const_cast<double*>(b);
  right.xtype = CHOLMOD_REAL;
  right.dtype = CHOLMOD_DOUBLE;
  const int ok = cholmod_solve2(CHOLMOD_A, impl_->factor, &right, nullptr, &impl_->solution,
                                nullptr, &impl_->work_y, &impl_->work_e, &impl_->common);
  if (!ok) throw NumericalError("solve", "CHOLMOD could not solve the system");
  std::copy_n(static_cast<const double*>(impl_->solution->x), right.nrow, x);
}

Index CholmodFactor::negative_pivots() const {
  const auto& factor = *impl_->factor;
  const auto* starts = static_cast<const int*>(factor.p);
  const auto* values = static_cast<const double*>(factor.x);
  Index count = 0;
  for (std::size_t column = 0; column < factor.n; ++column) {
    if (values[starts[column]] < 0.0) ++count;
  }
  return count;
}

}  // namespace isotherm::spectral::detail
