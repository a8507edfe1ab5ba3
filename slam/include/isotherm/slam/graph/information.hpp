#pragma once

#include <Eigen/Core>

namespace isotherm::slam {

/// Variance given to a direction about which an information matrix says
/// nothing: a standard deviation of 10^6 metres or radians, beyond every map.
inline constexpr double kUnknownVariance = 1e12;

/// Covariance that belongs to a symmetric positive semi-definite information
/// matrix. Directions without information get kUnknownVariance, so that a zero
/// matrix means "not known" rather than a division by zero. k x k, k = 3 or 6.
/// @throws NumericalError if an entry is not finite.
template <int Dof>
Eigen::Matrix<double, Dof, Dof> covariance_from_information(
    const Eigen::Matrix<double, Dof, Dof>& information);

/// Whether odometry with this information can be chained and solved for: neither singular
/// nor with entries on the diagonal further apart than 10^12. A zero matrix counts as usable:
/// it says "not known". k x k, k = 3 or 6.
template <int Dof>
bool is_usable_information(const Eigen::Matrix<double, Dof, Dof>& information);

/// The usable matrix that is nearest in meaning: deviations too small beside the largest
/// grow, and a direction without information gets a little.
/// @throws NumericalError if an entry is not finite.
template <int Dof>
Eigen::Matrix<double, Dof, Dof> usable_information(
    const Eigen::Matrix<double, Dof, Dof>& information);

}  // namespace isotherm::slam
