#pragma once

#include <vector>

#include <Eigen/Core>

#include "isotherm/spectral/types.hpp"

namespace isotherm::spectral::detail {

/// Points in boxes that halve again and again, to count those near a place. nanoflann's tree, which
/// visits every point that it counts, takes 6 to 10 times as long (docs/results/libraries.md).
class PointTree {
 public:
  /// `points` (dimension x points, finite) must outlive it. O(n log n).
  explicit PointTree(const Eigen::MatrixXd& points);

  /// How many points are nearer to this one than another is, itself left out: 0 for the
  /// nearest. Points as far as the other are not nearer. O(sqrt n) in the plane.
  Index count_nearer(Index point, Index other) const;

 private:
  struct Box {
    Eigen::VectorXd low;
    Eigen::VectorXd high;
    Index begin = 0;  // of its points in `order_`
    Index end = 0;
    Index first_half = -1;  // boxes; -1 if it is not halved
    Index second_half = -1;
  };

  Index make_box(Index begin, Index end);
  double squared_distance(Index a, Index b) const;
  Index count(const Box& box, Index centre, double squared) const;  // nearer than that

  const Eigen::MatrixXd& points_;
  std::vector<Index> order_;
  std::vector<Box> boxes_;
  Index root_ = -1;
};

}  // namespace isotherm::spectral::detail
