#include "isotherm/geometry/points/point_cloud.hpp"

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "isotherm/base/csv.hpp"
#include "isotherm/spectral/types.hpp"

namespace isotherm::geometry {

PointCloudFile read_points(TextReader& reader) {
  constexpr std::uint64_t kMostPoints = std::numeric_limits<spectral::Index>::max();
  PointCloudFile file;
  file.report.path = reader.path();
  file.report.format = "points";
  CsvReader csv(std::move(reader));
  std::vector<double> coordinates;
  std::size_t dimension = 0;
  std::uint64_t count = 0;
  while (csv.next_row()) {
    if (count == 0) dimension = csv.field_count();
    if (csv.field_count() > dimension) {
      csv.fail(dimension, "expected " + std::to_string(dimension) + " coordinates, as above");
    }
    if (count == kMostPoints) csv.fail(0, "more points than can be counted");
    for (std::size_t axis = 0; axis < dimension; ++axis) {
      coordinates.push_back(csv.number(axis, "a coordinate"));
    }
    ++count;
  }
  file.report.lines = csv.line_number();
  file.report.records["point"] = count;
  if (count == 0) {
    throw ParseError({file.report.path, 0, 0}, "", "no point; expected rows of coordinates");
  }
  file.points = Eigen::Map<const Eigen::MatrixXd>(
      coordinates.data(), static_cast<Eigen::Index>(dimension), static_cast<Eigen::Index>(count));
  return file;
}

PointCloudFile read_points(const std::string& path) {
  TextReader reader(path);
  return read_points(reader);
}

}  // namespace isotherm::geometry
