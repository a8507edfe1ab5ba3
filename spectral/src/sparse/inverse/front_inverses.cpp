#include "sparse/inverse/front_inverses.hpp"

#include <algorithm>
#include <utility>

#include "sparse/dense_kernels.hpp"

namespace isotherm::spectral::detail {
namespace {

template <class Scalar>
void invert_small_front(const EliminatedFront<Scalar>& eliminated, Scalar* inverse,
                        Eigen::Index order, Eigen::Index width) {
  const Eigen::Index outside = order - width;
  const Scalar* corner = inverse + width * order + width;
  for (Eigen::Index k = 0; k < width; ++k) {
    Scalar* below = inverse + k * order + width;
    std::fill_n(below, outside, Scalar(0.0));
    for (Eigen::Index j = 0; j < outside; ++j) {
      subtract_multiple(below, corner + j * order, eliminated.x[k * outside + j], outside);
    }
    for (Eigen::Index i = 0; i < outside; ++i) inverse[(width + i) * order + k] = below[i];
    for (Eigen::Index j = 0; j < width; ++j) {
      Scalar sum = eliminated.pivots[j + k * width];
      for (Eigen::Index i = 0; i < outside; ++i) {
        sum -= multiply(eliminated.x[j * outside + i], below[i]);
      }
      inverse[k * order + j] = sum;
    }
  }
}

template <class View, class Scalar>
void invert_large_front(const EliminatedFront<Scalar>& eliminated, View inverse,
                        Eigen::Index width) {
  using ConstView = Eigen::Map<const typename FrontInverses<Scalar>::Matrix>;
  const Eigen::Index outside = inverse.rows() - width;
  inverse.topLeftCorner(width, width) = ConstView(eliminated.pivots, width, width);
  if (outside == 0) return;
  const ConstView x(eliminated.x, outside, width);
  auto below = inverse.bottomLeftCorner(outside, width);
  below.setZero();
  add_product(below, -1.0, inverse.bottomRightCorner(outside, outside), x);
  add_symmetric_product(inverse.topLeftCorner(width, width), -1.0, x, below);
  inverse.topRightCorner(width, outside) = below.transpose();
}

Eigen::Index order_of(const FrontTree& tree, Index front) {
  return Eigen::Index{tree.size(front)} * tree.block_size();
}

// On any way to a root, of which all fronts are held at once.
Eigen::Index most_entries(const FrontTree& tree) {
  std::vector<Eigen::Index> on_the_way(static_cast<std::size_t>(tree.front_count()));
  Eigen::Index most = 0;
  for (Index front = tree.front_count() - 1; front >= 0; --front) {
    const Index parent = tree.parent(front);
    const Eigen::Index order = order_of(tree, front);
    on_the_way[front] = order * order + (parent < 0 ? 0 : on_the_way[parent]);
    most = std::max(most, on_the_way[front]);
  }
  return most;
}

}  // namespace

// Room for all at once, of which the system gives what is written: it is not moved as it grows.
template <class Scalar>
FrontInverses<Scalar>::FrontInverses(const FrontTree& tree)
    : tree_(tree), stack_(most_entries(tree)) {}

template <class Scalar>
typename FrontInverses<Scalar>::View FrontInverses<Scalar>::enter(
    Index front, const EliminatedFront<Scalar>& eliminated) {
  while (!ancestors_.empty() && ancestors_.back().front != tree_.parent(front)) {
    top_ = ancestors_.back().begin;
    ancestors_.pop_back();
  }
  const Eigen::Index order = order_of(tree_, front);
  const Eigen::Index width = Eigen::Index{tree_.width(front)} * tree_.block_size();
  const Eigen::Index begin = std::exchange(top_, top_ + order * order);
  const View inverse(stack_.data() + begin, order, order, Eigen::OuterStride<>(order));
  if (order > width) {
    gather(front, View(stack_.data() + begin + width * (order + 1), order - width, order - width,
                       Eigen::OuterStride<>(order)));
  }
  ancestors_.push_back({front, begin});
  if (order <= kSmallFront) {
    invert_small_front(eliminated, stack_.data() + begin, order, width);
  } else {
    invert_large_front(eliminated, inverse, width);
  }
  return inverse;
}

// Z_RR, from the parent's front.
template <class Scalar>
void FrontInverses<Scalar>::gather(Index front, View corner) {
  const int d = tree_.block_size();
  places_.clear();
  for (const Index place : tree_.place_in_parent(front)) {
    for (int k = 0; k < d; ++k) places_.push_back(Eigen::Index{place} * d + k);
  }
  const Scalar* source = stack_.data() + ancestors_.back().begin;
  const Eigen::Index stride = order_of(tree_, tree_.parent(front));
  for (Eigen::Index j = 0; j < corner.cols(); ++j) {
    const Scalar* from = source + places_[j] * stride;
    Scalar* to = corner.data() + j * corner.outerStride();
    for (Eigen::Index i = 0; i < corner.rows(); ++i) to[i] = from[places_[i]];
  }
}

template class FrontInverses<double>;
template class FrontInverses<std::complex<double>>;

}  // namespace isotherm::spectral::detail
