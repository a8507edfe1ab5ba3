#include "io/unused_records.hpp"

#include <array>
#include <utility>

namespace isotherm::slam::detail {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 22> kUnused = {{
    {"VERTEX_XY", "a landmark"},
    {"VERTEX_TRACKXYZ", "a landmark"},
    {"VERTEX_POINT_XY", "a landmark"},
    {"EDGE_SE2_XY", "an observation of a landmark"},
    {"EDGE_SE3_XYZ", "an observation of a landmark"},
    {"EDGE_SE3_TRACKXYZ", "an observation of a landmark"},
    {"EDGE_BEARING_SE2_XY", "an observation of a landmark"},
    {"EDGE_SE2_POINTXY", "an observation of a landmark"},
    {"EDGE_SE2_POINTXY_BEARING", "an observation of a landmark"},
    {"EDGE_SE2_XY_CALIB", "an observation of a landmark"},
    {"LANDMARK2", "an observation of a landmark"},
    {"EDGE_POINTXY", "an edge between landmarks"},
    {"EDGE_PRIOR_SE2", "a prior on a pose"},
    {"EDGE_SE2_PRIOR", "a prior on a pose"},
    {"EDGE_PRIOR_SE2_XY", "a prior on a position"},
    {"EDGE_SE3_PRIOR", "a prior on a pose"},
    {"EDGE_POINTXYZ_PRIOR", "a prior on a position"},
    {"EDGE_SE3_XYZPRIOR", "a prior on a position"},
    {"EDGE_SE3_GRAVITY", "a measurement of gravity"},
    {"EDGE_RANGE", "a range; 'isotherm localize' uses ranges"},
    {"PARAMS_SE2OFFSET", "the place of a sensor"},
    {"PARAMS_SE3OFFSET", "the place of a sensor"},
}};

}  // namespace

std::string_view unused_record(std::string_view tag) {
  for (const auto& [name, what] : kUnused) {
    if (tag == name) return what;
  }
  return {};
}

}  // namespace isotherm::slam::detail
