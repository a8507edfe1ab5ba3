#include "sparse/cholmod_factor.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <cholmod.h>

#include "isotherm/base/blas_threads.hpp"
#include "isotherm/base/error.hpp"
#include "sparse/find_supernodes.hpp"

namespace isotherm::spectral::detail {
namespace {

#ifdef ISOTHERM_WITH_GPL
constexpr bool kSupernodalModule = true;
#else
constexpr bool kSupernodalModule = false;
#endif

// Parts with fewer nodes are ordered by minimum degree. Of 4, 50, 200 and 1,000 this gives the
// fewest operations in cities, spheres and grids of 10^5 poses, or within 2 % of them; METIS's own
// order takes from 1 % less to 11 % more.
constexpr std::size_t kSmallestDissected = 200;

cholmod_sparse view_of(const LowerTriangle& matrix) {
  cholmod_sparse view = {};
  view.nrow = view.ncol = matrix.starts.size() - 1;
  view.nzmax = matrix.rows.size();
  view.p = const_cast<Index*>(matrix.starts.data());
  view.i = const_cast<Index*>(matrix.rows.data());
  view.x = const_cast<double*>(matrix.values);
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = matrix.values == nullptr ? CHOLMOD_PATTERN : CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

cholmod_dense view_of(const double* values, std::size_t rows, std::size_t columns) {
  cholmod_dense view = {};
  view.nrow = view.d = rows;
  view.ncol = columns;
  view.nzmax = rows * columns;
  view.x = const_cast<double*>(values);
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  return view;
}

template <class T>
std::span<const T> span_of(const void* data, std::size_t count) {
  return {static_cast<const T*>(data), count};
}

int storage(FactorKind kind) {
  if (!kSupernodalModule || kind == FactorKind::symmetric) return CHOLMOD_SIMPLICIAL;
  return kind == FactorKind::supernodal ? CHOLMOD_SUPERNODAL : CHOLMOD_AUTO;
}

struct Workspace {
  cholmod_common common = {};

  Workspace() {
    isotherm::detail::blas_serves_threads();  // makes it use one a call
    cholmod_start(&common);
    common.print = 0;
    common.error_handler = nullptr;
    common.quick_return_if_not_posdef = 1;
    common.postorder = 1;
  }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;
  ~Workspace() { cholmod_finish(&common); }
};

}  // namespace

struct CholmodFactor::Impl : Workspace {
  FactorKind kind = FactorKind::positive_definite;
  bool usable = false;
  cholmod_factor* factor = nullptr;
  cholmod_dense* solution = nullptr;
  cholmod_dense* work_y = nullptr;
  cholmod_dense* work_e = nullptr;
  SupernodeLayout layout;      // where the factor itself is not supernodal
  std::vector<double> values;  // of the same

  ~Impl() {
    cholmod_free_dense(&solution, &common);
    cholmod_free_dense(&work_y, &common);
    cholmod_free_dense(&work_e, &common);
    cholmod_free_factor(&factor, &common);
  }

  void check_usable() const {
    if (!usable) throw NumericalError("cholesky", "asked before a successful factorisation");
  }

  // Of L or D, in order of elimination.
  std::vector<double> pivots() const {
    const auto* x = static_cast<const double*>(factor->x);
    std::vector<double> result;
    result.reserve(factor->n);
    if (!factor->is_super) {
      for (const int start : span_of<int>(factor->p, factor->n)) result.push_back(x[start]);
      return result;
    }
    const auto* first_column = static_cast<const int*>(factor->super);
    const auto* row_start = static_cast<const int*>(factor->pi);
    const auto* value_start = static_cast<const int*>(factor->px);
    for (std::size_t s = 0; s < factor->nsuper; ++s) {
      const std::ptrdiff_t rows = row_start[s + 1] - row_start[s];
      for (std::ptrdiff_t k = 0; k < first_column[s + 1] - first_column[s]; ++k) {
        result.push_back(x[value_start[s] + k * (rows + 1)]);
      }
    }
    return result;
  }

  // From the columns of the simplicial factor.
  void copy_into_supernodes() {
    values.assign(static_cast<std::size_t>(layout.value_start.back()), 0.0);
    const auto* starts = static_cast<const int*>(factor->p);
    const auto* counts = static_cast<const int*>(factor->nz);
    const auto* rows = static_cast<const int*>(factor->i);
    const auto* x = static_cast<const double*>(factor->x);
    for (std::size_t s = 0; s + 1 < layout.first_column.size(); ++s) {
      double* target = values.data() + layout.value_start[s];
      const auto height = layout.row_start[s + 1] - layout.row_start[s];
      const Index* own_rows = layout.rows.data() + layout.row_start[s];
      for (Index c = layout.first_column[s]; c < layout.first_column[s + 1]; ++c) {
        for (int at = starts[c], place = 0; at < starts[c] + counts[c]; ++at) {
          while (own_rows[place] != rows[at]) ++place;
          target[place] = x[at];
        }
        target += height;
      }
    }
  }
};

CholmodFactor::CholmodFactor(const LowerTriangle& pattern, FactorKind kind,
                             std::span<const Index> order)
    : impl_(std::make_unique<Impl>()) {
  auto& common = impl_->common;
  impl_->kind = kind;
  common.supernodal = storage(kind);
  const bool accepts_indefinite =
      kind == FactorKind::symmetric || kind == FactorKind::known_definite;
  common.final_ll = accepts_indefinite ? 0 : 1;
  // Dense kernels pay only where blocks of columns are wide: in pose graphs of the plane
  // they rarely are, and column by column is twice as fast.
  if (kind == FactorKind::positive_definite) common.supernodal_switch = 120.0;
  cholmod_sparse view = view_of(pattern);
  if (order.empty()) {
    impl_->factor = cholmod_analyze(&view, &common);
  } else {
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_GIVEN;
    impl_->factor = cholmod_analyze_p(&view, const_cast<Index*>(order.data()), nullptr, 0, &common);
  }
  if (impl_->factor == nullptr) throw NumericalError("factorisation", "symbolic analysis failed");
  if (kind == FactorKind::supernodal && !impl_->factor->is_super) {
    impl_->layout = find_supernodes(
        pattern, span_of<Index>(impl_->factor->Perm, static_cast<std::size_t>(view.nrow)));
  }
}

CholmodFactor::CholmodFactor(const SparseMatrix& matrix, FactorKind kind)
    : CholmodFactor(lower_triangle(matrix), kind) {
  if (!factorise(lower_triangle(matrix))) {
    throw NumericalError("factorisation", "a pivot broke down");
  }
}

CholmodFactor::~CholmodFactor() = default;
CholmodFactor::CholmodFactor(CholmodFactor&&) noexcept = default;

bool CholmodFactor::factorise(const LowerTriangle& matrix) {
  auto& common = impl_->common;
  impl_->usable = false;
  common.status = CHOLMOD_OK;
  cholmod_sparse view = view_of(matrix);
  const isotherm::detail::SequentialOpenMp sequential;
  const bool ran = cholmod_factorize(&view, impl_->factor, &common) != 0;
  if (common.status < CHOLMOD_OK) {
    throw NumericalError("cholesky", "CHOLMOD failed with status " + std::to_string(common.status));
  }
  impl_->usable = ran && common.status == CHOLMOD_OK && impl_->factor->minor == impl_->factor->n;
  if (impl_->usable && !impl_->layout.first_column.empty()) impl_->copy_into_supernodes();
  return impl_->usable;
}

void CholmodFactor::solve(const double* b, double* x) {
  impl_->check_usable();
  cholmod_dense right = view_of(b, impl_->factor->n, 1);
  const int ok = cholmod_solve2(CHOLMOD_A, impl_->factor, &right, nullptr, &impl_->solution,
                                nullptr, &impl_->work_y, &impl_->work_e, &impl_->common);
  if (!ok) throw NumericalError("solve", "CHOLMOD could not solve the system");
  std::copy_n(static_cast<const double*>(impl_->solution->x), right.nrow, x);
}

Eigen::MatrixXd CholmodFactor::solve(const Eigen::MatrixXd& rhs) const {
  impl_->check_usable();
  cholmod_dense right = view_of(rhs.data(), static_cast<std::size_t>(rhs.rows()),
                                static_cast<std::size_t>(rhs.cols()));
  cholmod_dense* solution = cholmod_solve(CHOLMOD_A, impl_->factor, &right, &impl_->common);
  if (solution == nullptr) throw NumericalError("solve", "CHOLMOD could not solve the system");
  const Eigen::MatrixXd result = Eigen::Map<const Eigen::MatrixXd>(
      static_cast<const double*>(solution->x), rhs.rows(), rhs.cols());
  cholmod_free_dense(&solution, &impl_->common);
  return result;
}

double CholmodFactor::log_determinant() const {
  impl_->check_usable();
  double sum = 0.0;
  for (const double pivot : impl_->pivots()) sum += std::log(pivot);
  return impl_->factor->is_ll ? 2.0 * sum : sum;
}

Index CholmodFactor::negative_pivots() const {
  impl_->check_usable();
  const auto pivots = impl_->pivots();
  return static_cast<Index>(
      std::count_if(pivots.begin(), pivots.end(), [](double p) { return p < 0.0; }));
}

Supernodes CholmodFactor::supernodes() const {
  const cholmod_factor& factor = *impl_->factor;
  const auto order = span_of<Index>(factor.Perm, factor.n);
  if (!factor.is_super) {
    const auto& layout = impl_->layout;
    return {layout.first_column,
            layout.row_start,
            layout.rows,
            layout.value_start,
            impl_->usable ? std::span<const double>(impl_->values) : std::span<const double>{},
            order};
  }
  return {.first_column = span_of<Index>(factor.super, factor.nsuper + 1),
          .row_start = span_of<Index>(factor.pi, factor.nsuper + 1),
          .rows = span_of<Index>(factor.s, factor.ssize),
          .value_start = span_of<Index>(factor.px, factor.nsuper),
          .values = span_of<double>(factor.x, impl_->usable ? factor.xsize : 0),
          .order = order};
}

double CholmodFactor::flops() const { return impl_->common.fl; }
double CholmodFactor::entries() const { return impl_->common.lnz; }

LowerTriangle lower_triangle(const SparseMatrix& matrix) {
  const auto columns = static_cast<std::size_t>(matrix.cols());
  return {.starts = {matrix.outerIndexPtr(), columns + 1},
          .rows = {matrix.innerIndexPtr(), static_cast<std::size_t>(matrix.nonZeros())},
          .values = matrix.valuePtr()};
}

std::vector<Index> fill_reducing_order(const LowerTriangle& pattern) {
  Workspace workspace;
  auto& common = workspace.common;
  common.nmethods = 2;
  common.method[0].ordering = CHOLMOD_AMD;
  common.method[1].ordering = CHOLMOD_NESDIS;
  common.method[1].nd_small = kSmallestDissected;
  common.supernodal = CHOLMOD_SIMPLICIAL;
  cholmod_sparse view = view_of(pattern);
  cholmod_factor* symbolic = cholmod_analyze(&view, &common);
  if (symbolic == nullptr) throw NumericalError("ordering", "CHOLMOD could not order the graph");
  const auto order = span_of<Index>(symbolic->Perm, symbolic->n);
  std::vector<Index> result(order.begin(), order.end());
  cholmod_free_factor(&symbolic, &common);
  return result;
}

}  // namespace isotherm::spectral::detail
