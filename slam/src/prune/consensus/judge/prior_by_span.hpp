#pragma once

#include <array>
#include <span>

#include "prune/consensus/judge/span_class.hpp"

namespace isotherm::slam::detail {

using spectral::Index;

/// Prior odds of a loop, learnt from those decided so far: how many of them were true,
/// among loops that span about as many vertices.
///
/// Where false loops join places at random and true ones mostly join neighbours, a short
/// loop is very likely true. Spans are told apart by their power of two; a class with
/// few decided loops leans on the fraction of all (a Beta prior), which itself starts
/// at one half. No class has less than the odds of all: false loops are found out before
/// true ones are proven, and least is proven at first of those that span much.
class PriorBySpan {
 public:
  /// How a loop was decided.
  struct Decision {
    Index span = 0;  ///< vertices between its ends
    bool kept = false;
  };

  /// Before anything is decided.
  PriorBySpan() : PriorBySpan(std::span<const Decision>()) {}
  explicit PriorBySpan(std::span<const Decision> decided);

  double log_odds(Index span) const;

  /// Fraction of true loops among all.
  double fraction() const noexcept { return fraction_; }

 private:
  double fraction_ = 0.5;
  std::array<double, kSpanClasses> log_odds_{};
};

}  // namespace isotherm::slam::detail
