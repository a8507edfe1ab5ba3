#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace isotherm::network {

/// What a measured range is. In this order in all arrays. docs/concepts/ranges.md.
enum RangeKind : std::size_t {
  kCorrect,   ///< as long as the distance, with normal noise
  kTooLong,   ///< the same and an excess that is never negative, as without line of sight
  kAnything,  ///< any length the map allows
  kRangeKinds,
};

using ByKind = std::array<double, kRangeKinds>;

/// How the errors of ranges come about: measured = distance + error, by kind.
struct RangeMixture {
  double scale = 1.0;              ///< on the stated standard deviations
  ByKind share = {0.8, 0.1, 0.1};  ///< of the kinds
  double excess = 1.0;             ///< mean of that of ranges that are too long, metres
  double longest = 1.0;            ///< what can be any length is uniform up to here, metres

  double sigma(double stated) const { return scale * stated; }
};

/// Excess to begin with of ranges that are too long: between the noise, of `sigma`, and the longest
/// range.
double typical_excess(double sigma, double longest);

/// Counts the ranges that are too long among the correct ones.
void leave_out_too_long(RangeMixture& model);

/// A range's -log density at an error (measured less predicted), and what a step needs.
struct RangeLoss {
  double cost = 0.0;       ///< -log density, all kinds
  double slope = 0.0;      ///< its derivative by the error
  double curvature = 0.0;  ///< of the bound that EM takes for it here; >= 0
  ByKind probability{};    ///< of each kind
};

/// `variance` is that of the error where it is correct.
RangeLoss range_loss(const RangeMixture& model, double error, double variance);

/// What the range is most likely taken for: "correct", "too long" or "false".
const char* name_of(const RangeLoss& loss);

/// What a range would be with the others alone.
struct LeftOutRange {
  double error = 0.0;
  double variance = 0.0;
  bool checked = false;  ///< whether the others say anything of it
};

/// One step of Newton's from the estimate with the range: of this loss, error and variance of its
/// noise, which weighs `curvature` and whose prediction has the variance `predicted`.
LeftOutRange left_out(const RangeLoss& loss, double error, double noise, double predicted,
                      double curvature);

/// What a range is expected to say of the parameters.
struct RangeMoments {
  ByKind probability{};
  double squared_noise = 0.0;  ///< of the normal part, in variances, where it has one
  double excess = 0.0;         ///< expected where the range is too long, metres
};

RangeMoments range_moments(const RangeMixture& model, double error, double variance);

/// Sums of these over all ranges.
struct RangeStatistics {
  ByKind count{};
  double squared_noise = 0.0;
  double excess = 0.0;

  void add(const RangeMoments& moments);
};

/// The most likely shares of the kinds and mean excess. Shares have Dirichlet's prior after one
/// range of each kind; the excess one that is log-normal around `typical_excess`, a factor of ten
/// being one deviation, but no less than noise of `sigma` could hide. `too_long` says whether there
/// are such ranges at all.
void learn_kinds(const RangeStatistics& statistics, double typical_excess, double sigma,
                 bool too_long, RangeMixture& model);

/// The most likely scale, with the same prior around 1. Of the degrees of freedom of the errors, so
/// many are `fitted`: used up by the estimate.
double most_likely_scale(const RangeStatistics& statistics, double fitted, double scale);

/// The most likely factor on variances with this sum of squares, of which so many are left to tell
/// it, and the -log density of its prior: log-normal, a factor of ten in sigma being one deviation.
double most_likely_variance(double squares, double redundancy);
double log_scale_cost(double variance);

/// -log density of these priors at the model's parameters.
double log_prior_cost(const RangeMixture& model, double typical_excess, bool too_long);

}  // namespace isotherm::network
