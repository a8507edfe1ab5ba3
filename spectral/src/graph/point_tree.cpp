#include "graph/point_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace isotherm::spectral::detail {
namespace {

constexpr Index kLeaf = 16;  // points that are not worth halving

}  // namespace

PointTree::PointTree(const Eigen::MatrixXd& points) : points_(points), order_(points.cols()) {
  std::iota(order_.begin(), order_.end(), 0);
  if (!order_.empty()) root_ = make_box(0, static_cast<Index>(order_.size()));
}

Index PointTree::make_box(Index begin, Index end) {
  const std::vector<Index> inside(order_.begin() + begin, order_.begin() + end);
  const Eigen::MatrixXd points = points_(Eigen::all, inside);
  Box box{points.rowwise().minCoeff(), points.rowwise().maxCoeff(), begin, end};
  Eigen::Index axis = 0;
  const double extent = points.rows() == 0 ? 0.0 : (box.high - box.low).maxCoeff(&axis);
  if (end - begin > kLeaf && extent > 0.0) {
    const Index middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](Index a, Index b) { return points_(axis, a) < points_(axis, b); });
    box.first_half = make_box(begin, middle);
    box.second_half = make_box(middle, end);
  }
  boxes_.push_back(std::move(box));
  return static_cast<Index>(boxes_.size()) - 1;
}

Index PointTree::count_nearer(Index point, Index other) const {
  const double squared = squared_distance(point, other);
  return squared > 0.0 ? count(boxes_[root_], point, squared) - 1 : 0;
}

// Terms are added in the order of the axes, here as in `count`, so that no rounding comes between a
// point and the corner of its box.
double PointTree::squared_distance(Index a, Index b) const {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < points_.rows(); ++i) {
    const double arm = points_(i, a) - points_(i, b);
    sum += arm * arm;
  }
  return sum;
}

Index PointTree::count(const Box& box, Index centre, double squared) const {
  double nearest = 0.0;
  double farthest = 0.0;
  for (Eigen::Index i = 0; i < points_.rows(); ++i) {
    const double below = box.low[i] - points_(i, centre);
    const double above = points_(i, centre) - box.high[i];
    const double outside = std::max({below, above, 0.0});
    const double across = std::max(std::abs(below), std::abs(above));
    nearest += outside * outside;
    farthest += across * across;
  }
  if (nearest >= squared) return 0;
  if (farthest < squared) return box.end - box.begin;
  if (box.first_half >= 0) {
    return count(boxes_[box.first_half], centre, squared) +
           count(boxes_[box.second_half], centre, squared);
  }
  return static_cast<Index>(
      std::count_if(order_.begin() + box.begin, order_.begin() + box.end,
                    [&](Index p) { return squared_distance(p, centre) < squared; }));
}

}  // namespace isotherm::spectral::detail
