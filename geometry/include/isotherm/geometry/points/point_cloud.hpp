#pragma once

#include <string>

#include <Eigen/Core>

#include "isotherm/base/read_report.hpp"
#include "isotherm/base/text_reader.hpp"

namespace isotherm::geometry {

/// Points as a file has them.
struct PointCloudFile {
  Eigen::MatrixXd points;  ///< dimension x points, in the order of the file
  ReadReport report;
};

/// Reads a point a row, its coordinates separated by commas (`x,y[,z ...]`, any
/// dimension), with or without column names. O(size of the file) time and memory.
/// @throws FileError if the file cannot be read, ParseError if it has no point, a
///   coordinate is not a finite number, or rows differ in length.
PointCloudFile read_points(const std::string& path);

/// The same from a reader that stands at the start of its input.
PointCloudFile read_points(TextReader& reader);

}  // namespace isotherm::geometry
