#include "block_factor.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

namespace isotherm::slam::detail {

template <int Dof>
BlockFactor<Dof>::BlockFactor(Index count, std::span<const std::pair<Index, Index>> pairs)
    : order_(static_cast<std::size_t>(count)), position_(static_cast<std::size_t>(count)) {
  order_blocks(pairs);
  lay_out(pairs);
}

template <int Dof>
void BlockFactor<Dof>::order_blocks(std::span<const std::pair<Index, Index>> pairs) {
  using Pattern = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;
  std::vector<Eigen::Triplet<double, Index>> entries;
  entries.reserve(2 * pairs.size() + order_.size());
  for (const auto& [a, b] : pairs) {
    entries.emplace_back(a, b, 1.0);
    entries.emplace_back(b, a, 1.0);
  }
  // Eigen takes a row without a diagonal entry for a dense one.
  for (Index k = 0; k < count(); ++k) entries.emplace_back(k, k, 1.0);
  Pattern pattern(count(), count());
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, Index> permutation;
  if (count() > 0) Eigen::AMDOrdering<Index>()(pattern, permutation);
  for (Index k = 0; k < count(); ++k) {
    order_[k] = permutation.indices()[k];
    position_[order_[k]] = k;
  }
}

// The rows of column j of L are those of A and of the columns whose parent is j.
template <int Dof>
void BlockFactor<Dof>::lay_out(std::span<const std::pair<Index, Index>> pairs) {
  const Index n = count();
  std::vector<std::vector<Index>> below(order_.size());
  for (const auto& [a, b] : pairs) {
    const auto [first, second] = std::minmax(position_[a], position_[b]);
    below[first].push_back(second);
  }
  starts_.assign(1, 0);
  for (Index column = 0; column < n; ++column) {
    auto& rows = below[column];
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    rows_.insert(rows_.end(), rows.begin(), rows.end());
    starts_.push_back(rows_.size());
    if (!rows.empty()) {
      auto& inherited = below[rows.front()];
      inherited.insert(inherited.end(), rows.begin() + 1, rows.end());
    }
    std::vector<Index>().swap(rows);
  }
  diagonal_.assign(order_.size(), Block::Zero());
  off_diagonal_.assign(rows_.size(), Block::Zero());

  places_.reserve(pairs.size());
  for (const auto& [a, b] : pairs) {
    const auto [column, row] = std::minmax(position_[a], position_[b]);
    const Index* first = rows_.data() + starts_[column];
    const Index* last = rows_.data() + starts_[column + 1];
    const auto at = static_cast<std::size_t>(std::lower_bound(first, last, row) - rows_.data());
    // Below the diagonal stands (row, column): the pair itself if its first end is the row.
    places_.push_back({at, position_[a] < position_[b]});
  }
}

template <int Dof>
void BlockFactor<Dof>::clear() {
  std::fill(diagonal_.begin(), diagonal_.end(), Block::Zero());
  std::fill(off_diagonal_.begin(), off_diagonal_.end(), Block::Zero());
}

// Left-looking: column j is reduced by every earlier column with an entry in row
// j. Those columns wait in a list under the row they will be needed for next.
template <int Dof>
bool BlockFactor<Dof>::factorise() {
  constexpr Index kNone = -1;
  const Index n = count();
  std::vector<Index> waiting(order_.size(), kNone);
  std::vector<Index> next(order_.size(), kNone);
  std::vector<std::size_t> cursor(starts_.begin(), starts_.end() - 1);
  std::vector<std::size_t> place(order_.size(), 0);

  const auto wait = [&](Index column) {
    if (cursor[column] == starts_[column + 1]) return;
    const Index row = rows_[cursor[column]];
    next[column] = waiting[row];
    waiting[row] = column;
  };
  for (Index column = 0; column < n; ++column) {
    for (std::size_t at = starts_[column]; at < starts_[column + 1]; ++at) place[rows_[at]] = at;
    for (Index earlier = waiting[column]; earlier != kNone;) {
      const Index following = next[earlier];
      const std::size_t first = cursor[earlier]++;
      const Block pivot = off_diagonal_[first].transpose();
      diagonal_[column].noalias() -= off_diagonal_[first] * pivot;
      for (std::size_t at = first + 1; at < starts_[earlier + 1]; ++at) {
        off_diagonal_[place[rows_[at]]].noalias() -= off_diagonal_[at] * pivot;
      }
      wait(earlier);
      earlier = following;
    }
    if (!factorise_column(column)) return false;
    wait(column);
  }
  return true;
}

template <int Dof>
bool BlockFactor<Dof>::factorise_column(Index column) {
  const Eigen::LLT<Block> pivot(diagonal_[column]);
  if (pivot.info() != Eigen::Success) return false;
  diagonal_[column] = pivot.matrixL().solve(Block::Identity());
  const Block right = diagonal_[column].transpose();
  for (std::size_t at = starts_[column]; at < starts_[column + 1]; ++at) {
    off_diagonal_[at] = off_diagonal_[at] * right;
  }
  return true;
}

template <int Dof>
void BlockFactor<Dof>::solve(Eigen::VectorXd& x) const {
  const Index n = count();
  Eigen::Matrix<double, Dof, Eigen::Dynamic> y(Dof, n);
  for (Index k = 0; k < n; ++k) y.col(k) = x.segment<Dof>(Eigen::Index{order_[k]} * Dof);
  for (Index k = 0; k < n; ++k) {
    y.col(k) = diagonal_[k] * y.col(k);
    for (std::size_t at = starts_[k]; at < starts_[k + 1]; ++at) {
      y.col(rows_[at]).noalias() -= off_diagonal_[at] * y.col(k);
    }
  }
  for (Index k = n; k-- > 0;) {
    for (std::size_t at = starts_[k]; at < starts_[k + 1]; ++at) {
      y.col(k).noalias() -= off_diagonal_[at].transpose() * y.col(rows_[at]);
    }
    y.col(k) = diagonal_[k].transpose() * y.col(k);
    x.segment<Dof>(Eigen::Index{order_[k]} * Dof) = y.col(k);
  }
}

template <int Dof>
typename BlockFactor<Dof>::Block BlockFactor<Dof>::quadratic_form(Workspace& workspace, Index a,
                                                                  const Block& Ba, Index b,
                                                                  const Block& Bb) const {
  const Index root = count();
  Index first = root;
  Index second = root;
  if (a >= 0) workspace[first = position_[a]] += Ba;
  if (b >= 0) workspace[second = position_[b]] += Bb;
  Block form = Block::Zero();
  // Both paths ascend; after they meet they are one.
  while (first != root || second != root) {
    const Index column = std::min(first, second);
    const Block y = diagonal_[column] * workspace[column];
    workspace[column].setZero();
    form.noalias() += y.transpose() * y;
    for (std::size_t at = starts_[column]; at < starts_[column + 1]; ++at) {
      workspace[rows_[at]].noalias() -= off_diagonal_[at] * y;
    }
    const Index up = parent(column);
    if (first == column) first = up;
    if (second == column) second = up;
  }
  return form;
}

template class BlockFactor<3>;
template class BlockFactor<6>;

}  // namespace isotherm::slam::detail
