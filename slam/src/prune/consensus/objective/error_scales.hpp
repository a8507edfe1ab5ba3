#pragma once

#include <array>
#include <cstddef>

namespace isotherm::slam::detail {

/// How accurate a loop is: as most are, or less, by three or nine times in the variance, or as the
/// file states where that is less still. Against most first, so that the units of the file's
/// information play next to no part.
inline constexpr std::size_t kScaleCount = 4;
using ByScale = std::array<double, kScaleCount>;

inline constexpr double kNever = -1e9;  ///< log of no probability

/// What is believed of the scale of one loop.
struct ErrorScale {
  ByScale probability{};
  double weight = 1.0;    ///< mean of 1 / scale: the factor on its information
  double evidence = 0.0;  ///< mean of log(scale^(-dof/2) / probability)
};

/// How many loops are of which scale. Of the share of those that are worse than most nothing is
/// known before, nor which of them is how much so (a Dirichlet distribution).
struct ScaleShares {
  ByScale loops{};  ///< how many were found of each scale, as expected

  /// One more.
  void add(const ErrorScale& found);

  /// log of the probability of finding these, of parts a lower bound.
  double log_evidence() const;
};

/// Whether loops of these weights err as loops of different scales do.
bool are_of_different_scales(double weight, double other);

/// The same loops with another scale called that of most.
struct ScaleShift {
  double factor;  ///< on the variance of most
  ScaleShares shares;
};

/// The next one: those of most are worse, or are called worse.
ScaleShift wider_most(const ScaleShares& shares);

/// One a step below, of which half of most are.
ScaleShift sharper_most(const ScaleShares& shares);

/// The worst, of which all are.
ScaleShift all_as_worst(const ScaleShares& shares);

/// What is expected of the next loop.
struct ScaleMixture {
  double scale = 1.0;  ///< on the stated covariance, of most
  ByScale relative{};  ///< scales against that of most, ascending
  ByScale log_relative{};
  ByScale log_share{};

  /// Whether any can be of this scale.
  bool has(std::size_t scale_number) const { return log_share[scale_number] > kNever; }

  /// Of those that are not as accurate as most.
  double share_of_worse() const;
};

ScaleMixture expected_mixture(double scale, const ScaleShares& shares);

/// From log densities at each scale, of any common factor.
ErrorScale error_scale(const ScaleMixture& mixture, const ByScale& log_density, double dof);

/// From the squared Mahalanobis distance that is expected of the error, at the scale of most.
ErrorScale error_scale(const ScaleMixture& mixture, double chi2, double dof);

}  // namespace isotherm::slam::detail
