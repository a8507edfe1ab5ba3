#pragma once

#include <array>
#include <concepts>
#include <span>

#include "isotherm/base/options.hpp"
#include "isotherm/base/range.hpp"

/// Rules that split a list of distances into small (trusted) and large ones.
namespace isotherm::spectral {

enum class ThresholdRule {
  mean_sigma,  ///< mean + konst * standard deviation (paper eq. 11)
  otsu,        ///< largest between-class variance (Otsu 1979)
  mixture,     ///< where two log-normal components are equally likely
  gap,         ///< middle of the widest gap in the logarithms
};

constexpr std::array<EnumName<ThresholdRule>, 4> enum_names(ThresholdRule) {
  return {{{ThresholdRule::mean_sigma, "mean-sigma"},
           {ThresholdRule::otsu, "otsu"},
           {ThresholdRule::mixture, "mixture"},
           {ThresholdRule::gap, "gap"}}};
}

struct ThresholdOptions {
  ThresholdRule rule = ThresholdRule::mean_sigma;
  /// Standard deviations above the mean; the paper uses 0 to 4. Finite.
  double konst = 1.0;

  /// @throws InvalidArgument naming the field that is out of range.
  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, ThresholdOptions>
void visit_fields(Options& options, Visitor&& visitor) {
  visitor("threshold", options.rule, "how the threshold is found from the distances");
  visitor("konst", options.konst, "standard deviations above the mean (mean-sigma)",
          closed(-1e6, 1e6));
}

/// A threshold and how clearly it separates.
struct Threshold {
  double value = 0.0;  ///< distances above it are large
  /// In [0, 1]: share of the variance (of the logarithms, for `mixture` and
  /// `gap`) that the split explains. Near 0 the list has no two groups.
  double separation = 0.0;
  bool degenerate = false;  ///< nothing to split: `value` is +infinity
};

/// The threshold of `distances` (finite, >= 0, any order) by the given rule.
///
/// `mean_sigma` uses the population's standard deviation. The other rules adapt
/// by themselves; `mixture` and `gap` work on log(distance), zeros being raised
/// to 1e-12 of the largest distance. Fewer than two distances, or all equal, is
/// degenerate for the adapting rules; no distances at all, for every rule. O(q log q).
/// @throws InvalidArgument for a distance that is negative or not finite.
Threshold find_threshold(std::span<const double> distances, const ThresholdOptions& options = {});

}  // namespace isotherm::spectral
