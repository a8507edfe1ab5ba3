#pragma once

#include <array>
#include <cstddef>

namespace isotherm::slam::detail {

/// How accurate a loop is: as most are, or less, by three or nine times in the variance, or as the
/// file states where that is less still in a coordinate. Against most first, so that the units of
/// the file's information play next to no part.
inline constexpr std::size_t kScaleCount = 4;
inline constexpr std::size_t kAsStated = 3;
using ByScale = std::array<double, kScaleCount>;

inline constexpr double kNever = -1e100;  ///< log of no probability

/// Factors on the information of a loop that make it the mean inverse of its covariance.
struct LoopWeight {
  double learnt = 1.0;  ///< on that at the scale of most
  double stated = 0.0;  ///< on that which the file states: the probability that this is its own
};

/// What is believed of the scale of one loop.
struct ErrorScale {
  ByScale probability{};
  LoopWeight weight;
  double evidence =
      0.0;  ///< mean of log(|covariance|^(-1/2) / probability), |that of most| being 1
};

/// How many loops are of which scale. Of the share of those that are worse than most nothing is
/// known before, nor which of them is how much so (a Dirichlet distribution).
struct ScaleShares {
  ByScale loops{};  ///< how many were found of each scale, as expected

  /// One more.
  void add(const ErrorScale& found);

  double count() const;

  /// log of the probability of finding these, of parts a lower bound.
  double log_evidence() const;
};

/// Whether loops of these factors on their information err as loops of different scales do.
bool are_of_different_scales(double factor, double other);

/// The same loops with another scale called that of most.
struct ScaleShift {
  double factor;  ///< on the variance of most
  ScaleShares shares;
};

/// The next one: those of most are worse, or are called worse.
ScaleShift wider_most(const ScaleShares& shares);

/// One a step below, of which half of most are.
ScaleShift sharper_most(const ScaleShares& shares);

/// All as accurate as most.
ScaleShares all_as_most(const ScaleShares& shares);

/// The worst, of which all are.
ScaleShift all_as_worst(const ScaleShares& shares);

/// What is expected of the next loop.
struct ScaleMixture {
  double scale = 1.0;  ///< on the stated covariance, of most
  ByScale relative{};  ///< variances against those of most, ascending; as stated: in the mean
  ByScale log_relative{};
  ByScale log_share{};

  /// Whether any can be of this scale.
  bool has(std::size_t scale_number) const { return log_share[scale_number] > kNever; }

  /// Of those that are not as accurate as most.
  double share_of_worse() const;

  /// The mean of variances' inverses against those of most, by geometric means over coordinates.
  double factor(const LoopWeight& weight) const {
    return weight.learnt + weight.stated / relative.back();
  }
};

/// `sharpest`: of the factors on coordinates, beside the scale (Shapes), the least.
ScaleMixture expected_mixture(double scale, const ScaleShares& shares, double sharpest = 1.0);

/// What is expected of the squared Mahalanobis distance of a loop's error.
struct Misfit {
  double chi2 = 0.0;        ///< at the scale of most
  double stated = 0.0;      ///< as stated
  double dof = 0.0;         ///< coordinates that tell
  double log_stated = 0.0;  ///< log |stated covariance| of these, that of most being 1
};

/// From log densities at each scale, of any common factor; without the evidence.
ErrorScale error_scale(const ScaleMixture& mixture, const ByScale& log_density);

ErrorScale error_scale(const ScaleMixture& mixture, const Misfit& misfit);

}  // namespace isotherm::slam::detail
