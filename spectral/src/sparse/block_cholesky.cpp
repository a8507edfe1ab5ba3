#include "isotherm/spectral/sparse/block_cholesky.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <cholmod.h>

#include "isotherm/base/error.hpp"
#include "sparse/block_order.hpp"

namespace isotherm::spectral {
namespace {

cholmod_dense dense_view(Eigen::MatrixXd& matrix) {
  cholmod_dense view{};
  view.nrow = static_cast<std::size_t>(matrix.rows());
  view.ncol = static_cast<std::size_t>(matrix.cols());
  view.nzmax = static_cast<std::size_t>(matrix.size());
  view.d = view.nrow;
  view.x = matrix.data();
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  return view;
}

// A view of a lower triangle; `values` may be null for a bare pattern.
cholmod_sparse sparse_view(std::vector<int>& starts, std::vector<int>& rows, double* values) {
  cholmod_sparse view{};
  view.nrow = view.ncol = starts.size() - 1;
  view.nzmax = rows.size();
  view.p = starts.data();
  view.i = rows.data();
  view.x = values;
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = values == nullptr ? CHOLMOD_PATTERN : CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

// Rows of the blocks strictly below the diagonal, by block column, sorted and
// without repeats.
std::vector<std::vector<Index>> rows_below(Index block_count,
                                           std::span<const std::pair<Index, Index>> pairs) {
  std::vector<std::vector<Index>> below(static_cast<std::size_t>(block_count));
  for (const auto& [a, b] : pairs) below[std::min(a, b)].push_back(std::max(a, b));
  for (auto& rows : below) {
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  }
  return below;
}

}  // namespace

struct BlockCholesky::Factor {
  Factor() {
    cholmod_start(&common);
    common.print = 0;
  }
  ~Factor() {
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
  Factor(const Factor&) = delete;
  Factor& operator=(const Factor&) = delete;

  // The order of what is left of the graph that gives the sparsest factor.
  std::vector<int> core_order(const ChainElimination& chains) {
    if (chains.core.empty()) return {};
    std::vector<int> starts = {0};
    std::vector<int> rows;
    Index column = 0;
    for (const auto& below : rows_below(static_cast<Index>(chains.core.size()), chains.pairs)) {
      rows.push_back(column++);
      rows.insert(rows.end(), below.begin(), below.end());
      starts.push_back(static_cast<int>(rows.size()));
    }
    common.nmethods = 2;
    common.method[0].ordering = CHOLMOD_AMD;
    common.method[1].ordering = CHOLMOD_METIS;
    common.supernodal = CHOLMOD_SIMPLICIAL;
    common.postorder = 1;
    cholmod_sparse pattern = sparse_view(starts, rows, nullptr);
    cholmod_factor* symbolic = cholmod_analyze(&pattern, &common);
    if (symbolic == nullptr) throw NumericalError("ordering", "CHOLMOD could not order the graph");
    const int* permutation = static_cast<const int*>(symbolic->Perm);
    std::vector<int> order(permutation, permutation + symbolic->n);
    cholmod_free_factor(&symbolic, &common);
    return order;
  }

  void analyse(std::vector<int>& starts, std::vector<int>& rows, std::vector<int>& order,
               FactorForm form) {
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_GIVEN;
    common.supernodal = form == FactorForm::supernodal ? CHOLMOD_SUPERNODAL : CHOLMOD_AUTO;
    // Dense kernels pay only where blocks of columns are wide: in the plane they
    // rarely are, and column by column is twice as fast.
    common.supernodal_switch = 120.0;
    common.postorder = 1;
    common.final_ll = 1;  // LDL' would accept an indefinite matrix
    cholmod_sparse pattern = sparse_view(starts, rows, nullptr);
    factor = cholmod_analyze_p(&pattern, order.data(), nullptr, 0, &common);
    if (factor == nullptr) throw NumericalError("cholesky", "symbolic analysis failed");
  }

  // Of L, in order of elimination.
  std::vector<double> pivots() const {
    std::vector<double> result;
    if (factor == nullptr) return result;
    const auto* values = static_cast<const double*>(factor->x);
    if (!factor->is_super) {
      const auto* starts = static_cast<const int*>(factor->p);
      for (std::size_t k = 0; k < factor->n; ++k) result.push_back(values[starts[k]]);
      return result;
    }
    const auto* first_column = static_cast<const int*>(factor->super);
    const auto* row_start = static_cast<const int*>(factor->pi);
    const auto* value_start = static_cast<const int*>(factor->px);
    for (std::size_t s = 0; s < factor->nsuper; ++s) {
      const std::ptrdiff_t rows = row_start[s + 1] - row_start[s];
      for (std::ptrdiff_t k = 0; k < first_column[s + 1] - first_column[s]; ++k) {
        result.push_back(values[value_start[s] + k * (rows + 1)]);
      }
    }
    return result;
  }

  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  bool usable = false;
};

BlockCholesky::BlockCholesky(int block_size, Index block_count,
                             std::span<const std::pair<Index, Index>> pairs, FactorForm form)
    : block_size_(block_size), form_(form), diagonals_(static_cast<std::size_t>(block_count)) {
  lay_out(pairs);
  factor_ = std::make_unique<Factor>();
  if (block_count == 0) return;

  const ChainElimination chains = eliminate_chains(block_count, pairs);
  std::vector<Index> blocks = chains.order;
  for (const int place : factor_->core_order(chains)) blocks.push_back(chains.core[place]);
  std::vector<int> order;
  order.reserve(static_cast<std::size_t>(size()));
  for (const Index block : blocks) {
    for (int k = 0; k < block_size_; ++k) order.push_back(block * block_size_ + k);
  }
  factor_->analyse(column_starts_, rows_, order, form_);
}

BlockCholesky::~BlockCholesky() = default;
BlockCholesky::BlockCholesky(BlockCholesky&&) noexcept = default;
BlockCholesky& BlockCholesky::operator=(BlockCholesky&&) noexcept = default;

void BlockCholesky::lay_out(std::span<const std::pair<Index, Index>> pairs) {
  const auto below = rows_below(block_count(), pairs);
  std::size_t blocks = below.size();
  for (const auto& rows : below) blocks += rows.size();
  const std::size_t entries = blocks * static_cast<std::size_t>(block_size_ * block_size_);
  if (entries > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw NumericalError("cholesky", "the system has more entries than 32-bit indices can count");
  }
  rows_.reserve(entries);
  column_starts_.reserve(static_cast<std::size_t>(size()) + 1);
  column_starts_.push_back(0);
  for (Index column = 0; column < block_count(); ++column) {
    const auto stride = static_cast<std::ptrdiff_t>(below[column].size() + 1) * block_size_;
    diagonals_[column] = {column_starts_.back(), stride};
    for (int k = 0; k < block_size_; ++k) {
      for (int r = 0; r < block_size_; ++r) rows_.push_back(column * block_size_ + r);
      for (const Index row : below[column]) {
        for (int r = 0; r < block_size_; ++r) rows_.push_back(row * block_size_ + r);
      }
      column_starts_.push_back(static_cast<int>(rows_.size()));
    }
  }
  values_.assign(rows_.size(), 0.0);

  pairs_.reserve(pairs.size());
  for (const auto& [a, b] : pairs) {
    const Index column = std::min(a, b);
    const auto& rows = below[column];
    const auto rank = std::lower_bound(rows.begin(), rows.end(), std::max(a, b)) - rows.begin();
    BlockPlace place = diagonals_[column];
    place.first += (rank + 1) * block_size_;
    pairs_.push_back({place, a < b});
  }
}

void BlockCholesky::clear() { std::fill(values_.begin(), values_.end(), 0.0); }

Eigen::VectorXd BlockCholesky::diagonal() const {
  Eigen::VectorXd result(size());
  for (Index block = 0; block < block_count(); ++block) {
    for (int k = 0; k < block_size_; ++k) {
      const BlockPlace& place = diagonals_[block];
      result[block * block_size_ + k] = values_[place.first + k * place.stride + k];
    }
  }
  return result;
}

void BlockCholesky::set_diagonal(const Eigen::VectorXd& diagonal) {
  for (Index block = 0; block < block_count(); ++block) {
    const BlockPlace& place = diagonals_[block];
    for (int k = 0; k < block_size_; ++k) {
      values_[place.first + k * place.stride + k] = diagonal[block * block_size_ + k];
    }
  }
}

Eigen::VectorXd BlockCholesky::multiply(const Eigen::VectorXd& x) const {
  Eigen::VectorXd product = Eigen::VectorXd::Zero(size());
  for (Eigen::Index column = 0; column < size(); ++column) {
    for (int at = column_starts_[column]; at < column_starts_[column + 1]; ++at) {
      const int row = rows_[at];
      if (row < column) continue;  // the upper half of a diagonal block
      product[row] += values_[at] * x[column];
      if (row != column) product[column] += values_[at] * x[row];
    }
  }
  return product;
}

bool BlockCholesky::factorise(const Eigen::VectorXd& damping) {
  factor_->usable = block_count() == 0;
  if (factor_->usable) return true;
  cholmod_common& common = factor_->common;
  common.status = CHOLMOD_OK;
  common.quick_return_if_not_posdef = 1;
  // The undamped diagonal is put back from a copy: (x + d) - d may differ from x.
  const Eigen::VectorXd undamped = diagonal();
  if (damping.size() > 0) set_diagonal(undamped + damping);
  cholmod_sparse matrix = sparse_view(column_starts_, rows_, values_.data());
  const bool ran = cholmod_factorize(&matrix, factor_->factor, &common) != 0;
  if (damping.size() > 0) set_diagonal(undamped);
  if (common.status < CHOLMOD_OK) {
    throw NumericalError("cholesky", "CHOLMOD failed with status " + std::to_string(common.status));
  }
  factor_->usable = ran && common.status == CHOLMOD_OK;
  return factor_->usable;
}

Eigen::MatrixXd BlockCholesky::solve(const Eigen::MatrixXd& rhs) const {
  if (!factor_->usable) throw NumericalError("cholesky", "solve without a factor");
  if (block_count() == 0) return rhs;
  Eigen::MatrixXd copy = rhs;
  cholmod_dense view = dense_view(copy);
  cholmod_dense* solution = cholmod_solve(CHOLMOD_A, factor_->factor, &view, &factor_->common);
  if (solution == nullptr) throw NumericalError("cholesky", "CHOLMOD could not solve");
  copy = Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(solution->x), rhs.rows(),
                                           rhs.cols());
  cholmod_free_dense(&solution, &factor_->common);
  return copy;
}

double BlockCholesky::log_determinant() const {
  if (!factor_->usable) throw NumericalError("cholesky", "a determinant without a factor");
  double sum = 0.0;
  for (const double pivot : factor_->pivots()) sum += std::log(pivot);
  return 2.0 * sum;
}

BlockCholesky::Supernodes BlockCholesky::supernodes() const {
  if (form_ != FactorForm::supernodal) {
    throw InvalidArgument("form", "the factor was not asked to be supernodal");
  }
  if (!factor_->usable) throw NumericalError("cholesky", "covariances without a factor");
  const cholmod_factor* factor = factor_->factor;
  if (factor == nullptr) return {};
  const auto ints = [](const void* data, std::size_t count) {
    return std::span(static_cast<const int*>(data), count);
  };
  return {.first_column = ints(factor->super, factor->nsuper + 1),
          .row_start = ints(factor->pi, factor->nsuper + 1),
          .rows = ints(factor->s, factor->ssize),
          .value_start = ints(factor->px, factor->nsuper),
          .values = {static_cast<const double*>(factor->x), factor->xsize},
          .order = ints(factor->Perm, factor->n)};
}

}  // namespace isotherm::spectral
