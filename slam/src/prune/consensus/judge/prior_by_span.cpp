#include "prune/consensus/judge/prior_by_span.hpp"

#include <algorithm>
#include <cmath>

namespace isotherm::slam::detail {
namespace {

// Loops that the fraction of all counts for in each class.
constexpr double kLean = 10.0;

struct Tally {
  double kept = 0.0;
  double decided = 0.0;

  void add(bool is_kept) {
    decided += 1.0;
    if (is_kept) kept += 1.0;
  }
};

}  // namespace

PriorBySpan::PriorBySpan(std::span<const Decision> decided) {
  Tally all{.kept = 1.0, .decided = 2.0};
  std::array<Tally, kSpanClasses> classes{};
  for (const auto& decision : decided) {
    all.add(decision.kept);
    classes[span_class(decision.span)].add(decision.kept);
  }
  fraction_ = all.kept / all.decided;
  const double odds = fraction_ / (1.0 - fraction_);
  for (std::size_t k = 0; k < kSpanClasses; ++k) {
    const double kept = classes[k].kept + kLean * fraction_;
    const double refuted = classes[k].decided - classes[k].kept + kLean * (1.0 - fraction_);
    log_odds_[k] = std::log(std::max(kept / refuted, odds));
  }
}

double PriorBySpan::log_odds(Index span) const { return log_odds_[span_class(span)]; }

}  // namespace isotherm::slam::detail
