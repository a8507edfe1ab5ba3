#pragma once

#include <string>
#include <string_view>

#include <Eigen/Core>

namespace isotherm::geometry::detail {

/// How every NumPy file begins.
inline constexpr std::string_view kNpyMagic = "\x93NUMPY";

/// The array of two axes that `bytes`, a whole NumPy file, holds: floats or integers of 4 or 8
/// bytes, little-endian, in either order.
/// @throws ParseError naming `path`
Eigen::MatrixXd read_npy(const std::string& path, std::string_view bytes);

}  // namespace isotherm::geometry::detail
