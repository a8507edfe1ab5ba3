#include "isotherm/geometry/curves/polyline.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "isotherm/base/error.hpp"

namespace isotherm::geometry {

template <int Dim>
Polyline<Dim>::Polyline(std::vector<Point> points) : points_(std::move(points)) {
  arc_lengths_.reserve(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!points_[i].allFinite()) {
      throw InvalidArgument("points[" + std::to_string(i) + "]", "must be finite");
    }
    arc_lengths_.push_back(i == 0 ? 0.0
                                  : arc_lengths_.back() + (points_[i] - points_[i - 1]).norm());
  }
}

template <int Dim>
typename Polyline<Dim>::Point Polyline<Dim>::at(double arc_length) const {
  if (points_.empty()) throw InvalidArgument("polyline", "has no points");
  const auto after = std::upper_bound(arc_lengths_.begin(), arc_lengths_.end(), arc_length);
  if (after == arc_lengths_.begin()) return points_.front();
  if (after == arc_lengths_.end()) return points_.back();
  const auto k = static_cast<std::size_t>(after - arc_lengths_.begin());
  const double share = (arc_length - arc_lengths_[k - 1]) / (arc_lengths_[k] - arc_lengths_[k - 1]);
  return points_[k - 1] + share * (points_[k] - points_[k - 1]);
}

template class Polyline<2>;
template class Polyline<3>;

}  // namespace isotherm::geometry
