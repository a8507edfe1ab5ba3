#include "isotherm/geometry/polyline.hpp"

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

template class Polyline<2>;
template class Polyline<3>;

}  // namespace isotherm::geometry
