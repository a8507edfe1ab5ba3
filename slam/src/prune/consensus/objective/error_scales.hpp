#pragma once

#include <array>
#include <cstddef>

namespace isotherm::slam::detail {

/// How accurate a loop is: as most turn out to be, or as the file states.
inline constexpr std::size_t kScaleCount = 2;
using ByScale = std::array<double, kScaleCount>;

/// How many loops are which. Of the shares nothing is known before (a Dirichlet distribution
/// with one loop of each kind).
struct ScaleShares {
  ByScale loops{};  ///< how many were found of each scale, as expected

  /// log of the probability of finding these.
  double log_evidence() const;
};

/// What is expected of the next loop.
struct ScaleMixture {
  double scale = 1.0;  ///< on the stated covariance, of most
  /// Scales against that of most; of the second that of the file, where most are more accurate.
  ByScale relative{};
  ByScale log_share{};
};

ScaleMixture expected_mixture(double scale, const ScaleShares& shares);

/// What is believed of the scale of one loop.
struct ErrorScale {
  ByScale probability{};
  double weight = 1.0;    ///< mean of 1 / scale: the factor on its information
  double evidence = 0.0;  ///< mean of log(scale^(-dof/2) / probability)
};

/// From log densities at each scale, of any common factor. Scales are against that of most.
ErrorScale error_scale(const ScaleMixture& mixture, const ByScale& log_density, double dof);

/// From the squared Mahalanobis distance that is expected of the error, at the scale of most.
ErrorScale error_scale(const ScaleMixture& mixture, double chi2, double dof);

}  // namespace isotherm::slam::detail
