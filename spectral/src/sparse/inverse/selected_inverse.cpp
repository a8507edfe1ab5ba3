#include "sparse/inverse/selected_inverse.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

namespace isotherm::spectral::detail {
namespace {

/// Up to this many pivots are inverted by plain loops; more by blocked LU.
constexpr Index kSmallPivotBlock = 32;
/// Up to this order, plain loops beat the set-up of a blocked product.
constexpr Index kSmallFront = 24;

double multiply(double a, double b) { return a * b; }

/// Without the standard's treatment of infinities, which costs a call.
std::complex<double> multiply(const std::complex<double>& a, const std::complex<double>& b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

template <class Scalar>
using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
template <class Scalar>
using View = Eigen::Map<Matrix<Scalar>, 0, Eigen::OuterStride<>>;
template <class Scalar>
using ConstView = Eigen::Map<const Matrix<Scalar>, 0, Eigen::OuterStride<>>;

/// target -= factor * source, `count` entries.
template <class Scalar>
void subtract_multiple(Scalar* target, const Scalar* source, Scalar factor, Index count) {
  for (Index i = 0; i < count; ++i) target[i] -= multiply(factor, source[i]);
}

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

/// Factor and inverse of one shifted matrix, a dense front at a time.
///
/// Of supernode s with own columns J and further rows S, the factorisation
/// stores the inverse of the eliminated block, A_JJ^-1, above X = A_SJ A_JJ^-1.
/// They are all that the way back needs:
///   Z_SJ = -Z_SS X,   Z_JJ = A_JJ^-1 - X' Z_SJ.
template <class Scalar>
class SelectedInverse {
 public:
  SelectedInverse(const SupernodalStructure& structure, double scale, Scalar shift)
      : structure_(structure), scale_(scale), shift_(shift) {
    blocks_.resize(static_cast<std::size_t>(structure.block_start.back()));
    place_.resize(structure.size);
    const auto largest = static_cast<std::size_t>(structure.largest_front);
    front_.resize(largest * largest);
  }

  void factorise() {
    for (Index s = 0; s < structure_.supernode_count(); ++s) {
      assemble(s);
      eliminate(s);
    }
    updates_.clear();
    updates_.shrink_to_fit();
  }

  SelectedInverseQuality invert(const FrontQueries& queries,
                                std::span<SelectedEntries<Scalar>> entries) {
    row_sums_.assign(structure_.size, Scalar(0.0));
    for (Index s = structure_.supernode_count() - 1; s >= 0; --s) {
      const Scalar* inverse = invert_front(s);
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
    const double value = scale_ * structure_.entry_value[position];
    return diagonal ? shift_ + value : Scalar(value);
  }

  /// Fills the lower triangle of the front: original entries plus the updates
  /// that the children left on the stack.
  void assemble(Index s) {
    const auto& st = structure_;
    const Index order = st.front_size(s);
    const Index width = st.width(s);
    const Index* rows = st.rows.data() + st.row_start[s];
    for (Index k = 0; k < order; ++k) place_[rows[k]] = k;
    std::fill_n(front_.begin(), static_cast<std::size_t>(order) * width, Scalar(0.0));
    for (Index k = width; k < order; ++k) {
      std::fill(front_.begin() + (static_cast<std::ptrdiff_t>(k) * order + k),
                front_.begin() + static_cast<std::ptrdiff_t>(k + 1) * order, Scalar(0.0));
    }
    for (Index k = 0; k < width; ++k) {
      const Index column = st.first_column[s] + k;
      Scalar* target = front_.data() + static_cast<std::ptrdiff_t>(k) * order;
      for (Index e = st.entry_start[column]; e < st.entry_start[column + 1]; ++e) {
        target[place_[st.entry_row[e]]] += entry(e, st.entry_row[e] == column);
      }
    }
    for (Index child = 0; child < st.child_count[s]; ++child) add_update(order);
  }

  /// Takes the topmost update off the stack.
  void add_update(Index order) {
    const Index child = pending_.back();
    pending_.pop_back();
    const auto& st = structure_;
    const Index count = st.front_size(child) - st.width(child);
    const Index* place = st.place_in_parent.data() + st.row_start[child] + st.width(child);
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
    const Index order = structure_.front_size(s);
    const Index width = structure_.width(s);
    const Index outside = order - width;
    Scalar* block = blocks_.data() + structure_.block_start[s];
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

  /// The inverse on the rows of front s, both triangles, on top of the stack of
  /// its ancestors' ones.
  const Scalar* invert_front(Index s) {
    const auto& st = structure_;
    while (!ancestors_.empty() && ancestors_.back().supernode != st.parent[s]) {
      stack_.resize(ancestors_.back().begin);
      ancestors_.pop_back();
    }
    const Index order = st.front_size(s);
    const Index width = st.width(s);
    const Index outside = order - width;
    const std::size_t begin = stack_.size();
    stack_.resize(begin + static_cast<std::size_t>(order) * order);
    if (outside > 0) {
      const Index parent_order = st.front_size(st.parent[s]);
      gather(st.place_in_parent.data() + st.row_start[s] + width, outside,
             stack_.data() + ancestors_.back().begin, parent_order,
             stack_.data() + begin + static_cast<std::size_t>(width) * order + width, order);
    }
    ancestors_.push_back({s, begin});
    const Scalar* block = blocks_.data() + st.block_start[s];
    const Scalar* x = block + static_cast<std::ptrdiff_t>(width) * width;
    Scalar* inverse = stack_.data() + begin;
    if (order <= kSmallFront) {
      invert_small_front(block, x, inverse, order, width);
    } else {
      invert_large_front(block, x, inverse, order, width);
    }
    return inverse;
  }

  static void gather(const Index* place, Index count, const Scalar* source, Index source_stride,
                     Scalar* target, Index target_stride) {
    for (Index j = 0; j < count; ++j) {
      const Scalar* from = source + static_cast<std::ptrdiff_t>(place[j]) * source_stride;
      Scalar* to = target + static_cast<std::ptrdiff_t>(j) * target_stride;
      for (Index i = 0; i < count; ++i) to[i] = from[place[i]];
    }
  }

  void invert_small_front(const Scalar* block, const Scalar* x, Scalar* inverse, Index order,
                          Index width) {
    const Index outside = order - width;
    const Scalar* corner = inverse + width * order + width;
    for (Index k = 0; k < width; ++k) {
      Scalar* below = inverse + k * order + width;
      std::fill_n(below, outside, Scalar(0.0));
      for (Index j = 0; j < outside; ++j) {
        subtract_multiple(below, corner + j * order, x[k * outside + j], outside);
      }
      for (Index i = 0; i < outside; ++i) inverse[(width + i) * order + k] = below[i];
      for (Index j = 0; j < width; ++j) {
        Scalar sum = block[j + k * width];
        for (Index i = 0; i < outside; ++i) sum -= multiply(x[j * outside + i], below[i]);
        inverse[k * order + j] = sum;
      }
    }
  }

  void invert_large_front(const Scalar* block, const Scalar* x_data, Scalar* inverse_data,
                          Index order, Index width) {
    const Index outside = order - width;
    const ConstView<Scalar> pivots(block, width, width, Eigen::OuterStride<>(width));
    const ConstView<Scalar> x(x_data, outside, width, Eigen::OuterStride<>(std::max(1, outside)));
    View<Scalar> inverse(inverse_data, order, order, Eigen::OuterStride<>(order));
    inverse.topLeftCorner(width, width) = pivots;
    if (outside == 0) return;
    const auto corner = inverse.bottomRightCorner(outside, outside);
    inverse.bottomLeftCorner(outside, width).noalias() = -corner * x;
    inverse.topLeftCorner(width, width).noalias() -=
        x.transpose() * inverse.bottomLeftCorner(outside, width);
    inverse.topRightCorner(width, outside) = inverse.bottomLeftCorner(outside, width).transpose();
  }

  void answer(Index s, const Scalar* inverse, const FrontQueries& queries,
              std::span<SelectedEntries<Scalar>> entries) const {
    const auto order = static_cast<std::size_t>(structure_.front_size(s));
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
    const auto& st = structure_;
    const Index order = st.front_size(s);
    const Index* rows = st.rows.data() + st.row_start[s];
    for (Index k = 0; k < order; ++k) place_[rows[k]] = k;
    for (Index k = 0; k < st.width(s); ++k) {
      const Index column = st.first_column[s] + k;
      for (Index e = st.entry_start[column]; e < st.entry_start[column + 1]; ++e) {
        const Index row = st.entry_row[e];
        const Scalar product = multiply(
            entry(e, row == column), inverse[static_cast<std::ptrdiff_t>(k) * order + place_[row]]);
        row_sums_[column] += product;
        if (row != column) row_sums_[row] += product;
      }
    }
  }

  struct Ancestor {
    Index supernode;
    std::size_t begin;  // of its inverse in stack_
  };

  const SupernodalStructure& structure_;
  double scale_;
  Scalar shift_;
  std::vector<Scalar> blocks_;   // what factorise() keeps
  std::vector<Index> place_;     // row -> position in the front at hand
  std::vector<Scalar> front_;    // the front at hand, lower triangle
  std::vector<Scalar> updates_;  // stack of Schur complements not yet added
  std::vector<Index> pending_;   // their supernodes
  std::vector<Scalar> stack_;    // inverses of the ancestors' fronts
  std::vector<Ancestor> ancestors_;
  std::vector<Scalar> row_sums_;  // diagonal of A Z
};

}  // namespace

template <class Scalar>
SelectedInverseQuality selected_entries(const SupernodalStructure& structure,
                                        const FrontQueries& queries, double scale, Scalar shift,
                                        std::span<SelectedEntries<Scalar>> entries) {
  if (structure.size == 0) return {};
  SelectedInverse<Scalar> inverse(structure, scale, shift);
  inverse.factorise();
  return inverse.invert(queries, entries);
}

template SelectedInverseQuality selected_entries<double>(const SupernodalStructure&,
                                                         const FrontQueries&, double, double,
                                                         std::span<SelectedEntries<double>>);
template SelectedInverseQuality selected_entries<std::complex<double>>(
    const SupernodalStructure&, const FrontQueries&, double, std::complex<double>,
    std::span<SelectedEntries<std::complex<double>>>);

}  // namespace isotherm::spectral::detail
