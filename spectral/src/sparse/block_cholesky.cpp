#include "isotherm/spectral/sparse/block_cholesky.hpp"

#include <algorithm>
#include <limits>

#include "isotherm/base/error.hpp"
#include "sparse/block_order.hpp"
#include "sparse/cholmod_factor.hpp"

namespace isotherm::spectral {
namespace {

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

// The order of what is left of the graph that gives the sparsest factor.
std::vector<Index> core_order(const detail::ChainElimination& chains) {
  if (chains.core.empty()) return {};
  std::vector<Index> starts = {0};
  std::vector<Index> rows;
  Index column = 0;
  for (const auto& below : rows_below(static_cast<Index>(chains.core.size()), chains.pairs)) {
    rows.push_back(column++);
    rows.insert(rows.end(), below.begin(), below.end());
    starts.push_back(static_cast<Index>(rows.size()));
  }
  return detail::fill_reducing_order({starts, rows});
}

}  // namespace

BlockCholesky::BlockCholesky(int block_size, Index block_count,
                             std::span<const std::pair<Index, Index>> pairs, FactorForm form)
    : block_size_(block_size), form_(form), diagonals_(static_cast<std::size_t>(block_count)) {
  lay_out(pairs);
  if (block_count == 0) return;

  const detail::ChainElimination chains = detail::eliminate_chains(block_count, pairs);
  std::vector<Index> blocks = chains.order;
  for (const int place : core_order(chains)) blocks.push_back(chains.core[place]);
  std::vector<Index> order;
  order.reserve(static_cast<std::size_t>(size()));
  for (const Index block : blocks) {
    for (int k = 0; k < block_size_; ++k) order.push_back(block * block_size_ + k);
  }
  const auto kind = form == FactorForm::supernodal ? detail::FactorKind::supernodal
                                                   : detail::FactorKind::positive_definite;
  factor_ = std::make_unique<detail::CholmodFactor>(detail::LowerTriangle{column_starts_, rows_},
                                                    kind, order);
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
  if (block_count() == 0) return true;
  const detail::LowerTriangle matrix{column_starts_, rows_, values_.data()};
  if (damping.size() == 0) return factor_->factorise(matrix);
  // The undamped diagonal is put back from a copy: (x + d) - d may differ from x.
  const Eigen::VectorXd undamped = diagonal();
  set_diagonal(undamped + damping);
  const bool definite = factor_->factorise(matrix);
  set_diagonal(undamped);
  return definite;
}

Eigen::MatrixXd BlockCholesky::solve(const Eigen::MatrixXd& rhs) const {
  return block_count() == 0 ? rhs : factor_->solve(rhs);
}

double BlockCholesky::log_determinant() const {
  return block_count() == 0 ? 0.0 : factor_->log_determinant();
}

double BlockCholesky::flops() const { return block_count() == 0 ? 0.0 : factor_->flops(); }

detail::Supernodes BlockCholesky::supernodes() const {
  if (form_ != FactorForm::supernodal) {
    throw InvalidArgument("form", "the factor was not asked to be supernodal");
  }
  return block_count() == 0 ? detail::Supernodes{} : factor_->supernodes();
}

}  // namespace isotherm::spectral
