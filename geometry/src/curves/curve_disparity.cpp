#include <algorithm>
#include <cmath>
#include <complex>

#include "isotherm/base/error.hpp"
#include "isotherm/geometry/curves/lap_line.hpp"

namespace isotherm::geometry {
namespace {

using Offsets2 = Eigen::Matrix<double, 1, Eigen::Dynamic>;
using Offsets3 = Eigen::Matrix<double, 2, Eigen::Dynamic>;

double squared_difference(const Offsets2& a, const Offsets2& b) { return (a - b).squaredNorm(); }

// The least over rotations R of the sum of |a - R b|^2, with the offsets as complex
// numbers: the best R is the phase of sum a conj(b).
double squared_difference(const Offsets3& a, const Offsets3& b) {
  std::complex<double> correlation = 0.0;
  for (Eigen::Index k = 0; k < a.cols(); ++k) {
    correlation += std::complex(a(0, k), a(1, k)) * std::conj(std::complex(b(0, k), b(1, k)));
  }
  const double size = std::abs(correlation);
  if (!(size > 0.0)) return a.squaredNorm() + b.squaredNorm();
  const std::complex<double> best = correlation / size;
  Eigen::Matrix2d rotation;
  rotation << best.real(), -best.imag(), best.imag(), best.real();
  return (a - rotation * b).squaredNorm();
}

}  // namespace

template <int Dim>
CurveDescriptor<Dim> reversed(const CurveDescriptor<Dim>& descriptor) {
  CurveDescriptor<Dim> result = descriptor;
  result.behind = descriptor.ahead;
  result.ahead = descriptor.behind;
  result.direction = -descriptor.direction;
  // Left becomes right; in space the in-plane axis stays and its normal turns over.
  result.offsets = descriptor.offsets.rowwise().reverse();
  result.offsets.row(Dim - 2) *= -1.0;
  return result;
}

template <int Dim>
CurveDisparity disparity(const CurveDescriptor<Dim>& a, const CurveDescriptor<Dim>& b) {
  if (a.interval != b.interval) throw InvalidArgument("interval", "must be the same for both");
  const int behind = std::min(a.behind, b.behind);
  const int count = behind + 1 + std::min(a.ahead, b.ahead);
  const double squared = squared_difference(a.offsets.middleCols(a.behind - behind, count).eval(),
                                            b.offsets.middleCols(b.behind - behind, count).eval());
  return {std::sqrt(squared / count), count};
}

template CurveDescriptor<2> reversed(const CurveDescriptor<2>&);
template CurveDescriptor<3> reversed(const CurveDescriptor<3>&);
template CurveDisparity disparity(const CurveDescriptor<2>&, const CurveDescriptor<2>&);
template CurveDisparity disparity(const CurveDescriptor<3>&, const CurveDescriptor<3>&);

}  // namespace isotherm::geometry
