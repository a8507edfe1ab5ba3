#pragma once

#include <cstddef>
#include <vector>

namespace isotherm::slam::detail {

/// How densely positive values lie on a logarithmic scale.
class OctaveCounts {
 public:
  /// Sorts in O(n log n).
  explicit OctaveCounts(std::vector<double> values);

  /// Ascending.
  const std::vector<double>& values() const noexcept { return values_; }

  /// How many lie within half an octave of `x`, as a number to calculate with.
  double around(double x) const;

  /// How many lie below `x`.
  std::size_t below(double x) const;

 private:
  std::vector<double> values_;
};

/// Whether a count of `a` independent events is more than one of `b` by more than chance.
bool more(double a, double b);

/// Places on the way from one octave to the next at which the counts are compared.
inline constexpr int kStepsPerOctave = 4;

}  // namespace isotherm::slam::detail
