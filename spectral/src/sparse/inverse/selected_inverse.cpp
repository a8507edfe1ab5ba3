#include "sparse/inverse/selected_inverse.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include "sparse/inverse/front_inverses.hpp"

namespace isotherm::spectral::detail {
namespace {

/// Up to this many pivots are inverted by plain loops; more by blocked LU.
constexpr Index kSmallPivotBlock = 32;
template <class Scalar>
using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
template <class Scalar>
using View = Eigen::Map<Matrix<Scalar>, 0, Eigen::OuterStride<>>;
template <class Scalar>
using ConstView = Eigen::Map<const Matrix<Scalar>, 0, Eigen::OuterStride<>>;

/// Inverts in place by Gauss-Jordan elimination on the diagonal, column by column.
template <class Scalar>
void invert_small(Scalar* a, Index order) {
  for (Index k = 0; k < order; ++k) {
    Scalar* pivot = a + k * order;
    const Scalar inverse = Scalar(1.0) / pivot[k];
    pivot[k] = Scalar(1.0);
    for (Index i = 0; i < order; ++i) pivot[i] = multiply(pivot[i], inverse);
    for (Index j = 0; j < order; ++j) {
      if (j == k) continue;
      const Scalar factor = a[k + j * order];
      a[k + j * order] = Scalar(0.0);
      subtract_multiple(a + j * order, pivot, factor, order);
    }
  }
}

/// Factor and inverse of one shifted matrix, a dense front at a time. The
/// factorisation keeps of each front what the way back needs: the inverse of the
/// eliminated block above X.
template <class Scalar>
class SelectedInverse {
 public:
  SelectedInverse(const FrontalMatrix& matrix, double scale, Scalar shift)
      : matrix_(matrix), tree_(matrix.tree), scale_(scale), shift_(shift) {
    place_.resize(matrix.size());
    child_count_.resize(tree_.front_count(), 0);
    block_start_.push_back(0);
    std::size_t largest = 0;
    for (Index s = 0; s < tree_.front_count(); ++s) {
      largest = std::max(largest, static_cast<std::size_t>(tree_.size(s)));
      block_start_.push_back(block_start_.back() + std::int64_t{tree_.size(s)} * tree_.width(s));
      if (tree_.parent(s) != FrontTree::kNone) ++child_count_[tree_.parent(s)];
    }
    blocks_.resize(static_cast<std::size_t>(block_start_.back()));
    front_.resize(largest * largest);
  }

  void factorise() {
    for (Index s = 0; s < tree_.front_count(); ++s) {
      assemble(s);
      eliminate(s);
    }
    updates_.clear();
    updates_.shrink_to_fit();
  }

  SelectedInverseQuality invert(const FrontQueries& queries,
                                std::span<SelectedEntries<Scalar>> entries) {
    row_sums_.assign(matrix_.size(), Scalar(0.0));
    FrontInverses<Scalar> inverses(tree_);
    for (Index s = tree_.front_count() - 1; s >= 0; --s) {
      const Scalar* block = blocks_.data() + block_start_[s];
      const std::ptrdiff_t width = tree_.width(s);
      const Scalar* inverse = inverses.enter(s, {block, block + width * width}).data();
      answer(s, inverse, queries, entries);
      check(s, inverse);
    }
    SelectedInverseQuality quality;
    for (const Scalar& sum : row_sums_) {
      const double residual = std::abs(sum - Scalar(1.0));
      quality.residual = std::max(quality.residual, residual);
      quality.finite = quality.finite && std::isfinite(residual);
    }
    return quality;
  }

 private:
  Scalar entry(Index position, bool diagonal) const {
    const double value = scale_ * matrix_.entry_value[position];
    return diagonal ? shift_ + value : Scalar(value);
  }

  /// Fills the lower triangle of the front: original entries plus the updates
  /// that the children left on the stack.
  void assemble(Index s) {
    const Index order = tree_.size(s);
    const Index width = tree_.width(s);
    const auto rows = tree_.rows(s);
    for (Index k = 0; k < order; ++k) place_[rows[k]] = k;
    std::fill_n(front_.begin(), static_cast<std::size_t>(order) * width, Scalar(0.0));
    for (Index k = width; k < order; ++k) {
      std::fill(front_.begin() + (static_cast<std::ptrdiff_t>(k) * order + k),
                front_.begin() + static_cast<std::ptrdiff_t>(k + 1) * order, Scalar(0.0));
    }
    for (Index k = 0; k < width; ++k) {
      const Index column = rows[k];
      Scalar* target = front_.data() + static_cast<std::ptrdiff_t>(k) * order;
      for (Index e = matrix_.entry_start[column]; e < matrix_.entry_start[column + 1]; ++e) {
        target[place_[matrix_.entry_row[e]]] += entry(e, matrix_.entry_row[e] == column);
      }
    }
    for (Index child = 0; child < child_count_[s]; ++child) add_update(order);
  }

  /// Takes the topmost update off the stack.
  void add_update(Index order) {
    const Index child = pending_.back();
    pending_.pop_back();
    const Index count = tree_.size(child) - tree_.width(child);
    const auto place = tree_.place_in_parent(child);
    const auto begin = updates_.size() - static_cast<std::size_t>(count) * count;
    const Scalar* update = updates_.data() + begin;
    for (Index j = 0; j < count; ++j) {
      Scalar* target = front_.data() + static_cast<std::ptrdiff_t>(place[j]) * order;
      const Scalar* source = update + static_cast<std::ptrdiff_t>(j) * count;
      for (Index i = j; i < count; ++i) target[place[i]] += source[i];
    }
    updates_.resize(begin);
  }

  void eliminate(Index s) {
    const Index order = tree_.size(s);
    const Index width = tree_.width(s);
    const Index outside = order - width;
    Scalar* block = blocks_.data() + block_start_[s];
    invert_pivots(block, order, width);
    if (outside == 0) return;
    Scalar* x = block + static_cast<std::ptrdiff_t>(width) * width;
    const auto begin = updates_.size();
    updates_.resize(begin + static_cast<std::size_t>(outside) * outside);
    pending_.push_back(s);
    Scalar* update = updates_.data() + begin;
    if (order <= kSmallFront) {
      eliminate_small(block, x, update, order, width);
    } else {
      eliminate_large(block, x, update, order, width);
    }
  }

  void invert_pivots(Scalar* block, Index order, Index width) {
    for (Index j = 0; j < width; ++j) {
      for (Index i = j; i < width; ++i) {
        block[i + j * width] = block[j + i * width] =
            front_[i + static_cast<std::size_t>(j) * order];
      }
    }
    if (width <= kSmallPivotBlock) {
      invert_small(block, width);
    } else {
      View<Scalar> pivots(block, width, width, Eigen::OuterStride<>(width));
      pivots = pivots.partialPivLu().inverse().eval();
    }
  }

  void eliminate_small(const Scalar* inverse, Scalar* x, Scalar* update, Index order, Index width) {
    const Index outside = order - width;
    for (Index k = 0; k < width; ++k) {
      Scalar* target = x + k * outside;
      std::fill_n(target, outside, Scalar(0.0));
      for (Index j = 0; j < width; ++j) {
        subtract_multiple(target, front_.data() + j * order + width, -inverse[j + k * width],
                          outside);
      }
    }
    for (Index j = 0; j < outside; ++j) {
      Scalar* target = update + j * outside;
      const Scalar* source = front_.data() + (j + width) * order + width;
      std::copy(source + j, source + outside, target + j);
      for (Index k = 0; k < width; ++k) {
        subtract_multiple(target + j, x + k * outside + j, front_[k * order + width + j],
                          outside - j);
      }
    }
  }

  void eliminate_large(const Scalar* inverse, Scalar* x_data, Scalar* update_data, Index order,
                       Index width) {
    const Index outside = order - width;
    const ConstView<Scalar> pivots(inverse, width, width, Eigen::OuterStride<>(width));
    const ConstView<Scalar> below(front_.data() + width, outside, width,
                                  Eigen::OuterStride<>(order));
    const ConstView<Scalar> corner(
        front_.data() + static_cast<std::ptrdiff_t>(width) * order + width, outside, outside,
        Eigen::OuterStride<>(order));
    View<Scalar> x(x_data, outside, width, Eigen::OuterStride<>(outside));
    View<Scalar> update(update_data, outside, outside, Eigen::OuterStride<>(outside));
    x.noalias() = below * pivots;
    update.template triangularView<Eigen::Lower>() = corner;
    update.template triangularView<Eigen::Lower>() -= x * below.transpose();
  }

  void answer(Index s, const Scalar* inverse, const FrontQueries& queries,
              std::span<SelectedEntries<Scalar>> entries) const {
    const auto order = static_cast<std::size_t>(tree_.size(s));
    for (Index q = queries.start[s]; q < queries.start[s + 1]; ++q) {
      const auto& query = queries.queries[q];
      auto& answer = entries[query.pair];
      const auto first = static_cast<std::size_t>(query.first);
      answer.first = inverse[first * order + first];
      if (query.second < 0) continue;
      const auto second = static_cast<std::size_t>(query.second);
      answer.second = inverse[second * order + second];
      answer.cross = inverse[first * order + second];
      if (query.swapped) std::swap(answer.first, answer.second);
    }
  }

  /// Adds what the entries of s contribute to the diagonal of A Z.
  void check(Index s, const Scalar* inverse) {
    const Index order = tree_.size(s);
    const auto rows = tree_.rows(s);
    for (Index k = 0; k < order; ++k) place_[rows[k]] = k;
    for (Index k = 0; k < tree_.width(s); ++k) {
      const Index column = rows[k];
      for (Index e = matrix_.entry_start[column]; e < matrix_.entry_start[column + 1]; ++e) {
        const Index row = matrix_.entry_row[e];
        const Scalar product = multiply(
            entry(e, row == column), inverse[static_cast<std::ptrdiff_t>(k) * order + place_[row]]);
        row_sums_[column] += product;
        if (row != column) row_sums_[row] += product;
      }
    }
  }

  const FrontalMatrix& matrix_;
  const FrontTree& tree_;
  double scale_;
  Scalar shift_;
  std::vector<Scalar> blocks_;  // what factorise() keeps
  std::vector<std::int64_t> block_start_;
  std::vector<Index> child_count_;
  std::vector<Index> place_;      // row -> position in the front at hand
  std::vector<Scalar> front_;     // the front at hand, lower triangle
  std::vector<Scalar> updates_;   // stack of Schur complements not yet added
  std::vector<Index> pending_;    // their supernodes
  std::vector<Scalar> row_sums_;  // diagonal of A Z
};

}  // namespace

template <class Scalar>
SelectedInverseQuality selected_entries(const FrontalMatrix& matrix, const FrontQueries& queries,
                                        double scale, Scalar shift,
                                        std::span<SelectedEntries<Scalar>> entries) {
  if (matrix.size() == 0) return {};
  SelectedInverse<Scalar> inverse(matrix, scale, shift);
  inverse.factorise();
  return inverse.invert(queries, entries);
}

template SelectedInverseQuality selected_entries<double>(const FrontalMatrix&, const FrontQueries&,
                                                         double, double,
                                                         std::span<SelectedEntries<double>>);
template SelectedInverseQuality selected_entries<std::complex<double>>(
    const FrontalMatrix&, const FrontQueries&, double, std::complex<double>,
    std::span<SelectedEntries<std::complex<double>>>);

}  // namespace isotherm::spectral::detail
