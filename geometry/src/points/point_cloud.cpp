#include "isotherm/geometry/points/point_cloud.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "isotherm/base/csv.hpp"
#include "isotherm/spectral/types.hpp"
#include "points/npy_array.hpp"

namespace isotherm::geometry {
namespace {

constexpr std::uint64_t kMostPoints = std::numeric_limits<spectral::Index>::max();

class PointReader {
 public:
  explicit PointReader(TextReader reader) : csv_(std::move(reader)) {}

  void read(PointCloudFile& file) {
    while (csv_.next_row()) read_row();
    file.report.lines = csv_.line_number();
    file.report.records["point"] = count_;
    if (count_ == 0) {
      throw ParseError({file.report.path, 0, 0}, "", "no point; expected rows of coordinates");
    }
    file.points = Eigen::Map<const Eigen::MatrixXd>(coordinates_.data(),
                                                    static_cast<Eigen::Index>(axes_.size()),
                                                    static_cast<Eigen::Index>(count_));
    file.ids = std::move(ids_);
  }

 private:
  void read_row() {
    if (count_ == 0) find_columns();
    if (csv_.field_count() > width_) {
      csv_.fail(width_, "expected " + std::to_string(width_) + " coordinates, as above");
    }
    if (count_ == kMostPoints) csv_.fail(0, "more points than can be counted");
    for (const auto axis : axes_) coordinates_.push_back(csv_.number(axis, "a coordinate"));
    if (id_column_) ids_.push_back(csv_.unsigned_integer(*id_column_, "the number of a point"));
    ++count_;
  }

  // Names tell numbers of points from coordinates; without names all are coordinates.
  void find_columns() {
    width_ = csv_.field_count();
    for (const std::string_view name : {"id", "node", "vertex", "point", "index"}) {
      if (!id_column_) id_column_ = csv_.find_column(name);
    }
    for (std::size_t column = 0; column < width_; ++column) {
      if (column != id_column_) axes_.push_back(column);
    }
    if (axes_.empty()) csv_.fail(0, "expected coordinates beside the number of a point");
  }

  CsvReader csv_;
  std::size_t width_ = 0;
  std::optional<std::size_t> id_column_;
  std::vector<std::size_t> axes_;  // columns of coordinates
  std::vector<double> coordinates_;
  std::vector<std::uint64_t> ids_;
  std::uint64_t count_ = 0;
};

// Points in the order of their numbers.
void sort_by_id(PointCloudFile& file) {
  if (file.ids.empty()) {
    file.ids.resize(static_cast<std::size_t>(file.points.cols()));
    std::iota(file.ids.begin(), file.ids.end(), std::uint64_t{0});
    return;
  }
  std::vector<Eigen::Index> order(file.ids.size());
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return file.ids[a] < file.ids[b]; });
  std::sort(file.ids.begin(), file.ids.end());
  const auto repeated = std::adjacent_find(file.ids.begin(), file.ids.end());
  if (repeated != file.ids.end()) {
    throw ParseError({file.report.path, 0, 0}, std::to_string(*repeated),
                     "two points have this number");
  }
  file.points = file.points(Eigen::all, order).eval();
}

PointCloudFile read_array(const std::string& path, std::string_view bytes) {
  PointCloudFile file;
  file.report.path = path;
  file.report.format = "npy";
  file.points = detail::read_npy(path, bytes).transpose();
  file.report.records["point"] = static_cast<std::uint64_t>(file.points.cols());
  sort_by_id(file);
  return file;
}

}  // namespace

PointCloudFile read_points(TextReader& reader) {
  PointCloudFile file;
  file.report.path = reader.path();
  file.report.format = "points";
  PointReader(std::move(reader)).read(file);
  sort_by_id(file);
  return file;
}

PointCloudFile read_points(const std::string& path) {
  TextReader reader(path);
  if (!reader.peek().starts_with(detail::kNpyMagic)) return read_points(reader);
  if (path == "-") {
    throw ParseError({path, 0, 0}, "", "a NumPy array is read from a file, not from a stream");
  }
  return read_array(path, read_whole(path));
}

}  // namespace isotherm::geometry
