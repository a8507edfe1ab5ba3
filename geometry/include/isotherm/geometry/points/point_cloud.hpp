#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "isotherm/base/read_report.hpp"
#include "isotherm/base/text_reader.hpp"

namespace isotherm::geometry {

/// Points as a file has them.
struct PointCloudFile {
  Eigen::MatrixXd points;          ///< dimension x points
  std::vector<std::uint64_t> ids;  ///< the file's number of each point, ascending; else from 0
  ReadReport report;
};

/// Reads a point a row, its coordinates separated by commas (`x,y[,z ...]`, any
/// dimension), with or without column names; or a NumPy array of two axes, points x
/// coordinates (.npy, floats or integers). A column called `id`, `node`, `vertex`, `point` or
/// `index` numbers the points, by which they are ordered. O(size of the file) time and memory.
/// @throws FileError if the file cannot be read, ParseError if it has no point, a
///   coordinate is not a finite number, or rows differ in length.
PointCloudFile read_points(const std::string& path);

/// The same from a reader that stands at the start of its input.
PointCloudFile read_points(TextReader& reader);

}  // namespace isotherm::geometry
