#include "heat/rational_heat.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "isotherm/base/parallel.hpp"
#include "sparse/inverse/selected_inverse.hpp"

namespace isotherm::spectral::detail {
namespace {

/// Share of the tolerance that the approximation may take; the rest is for rounding.
constexpr double kApproximationShare = 0.9;

/// A target's quadratic form of (scale * L + shift)^-1, from the entries at its
/// ends in the order of `locate`.
template <class Scalar>
Scalar quadratic_form(const HeatTarget& target, SelectedEntries<Scalar> z, double scale) {
  const auto& excluded = target.excluded;
  if (!excluded.any()) return z.difference();
  // (A - s b b')^-1 = Z + s (Zb)(Zb)' / (1 - s b'Zb) with b = e_first - e_second.
  const Scalar strength = scale * excluded.weight;
  const Scalar whole = z.difference();
  const Scalar rest = 1.0 - strength * whole;
  if (!target.single()) return whole / rest;
  const Scalar part = z.first - z.cross;
  return z.first + strength * part * part / rest;
}

/// How much more than an inverse's entries a target's value can err: thinking
/// an edge away divides by 1 - s b'Zb, whose inverse is 1 + s b'Z'b.
double amplification(const HeatTarget& target, const PartialFraction& term, double scale) {
  if (!target.excluded.any()) return 1.0;
  const double factor = 1.0 + kLargestNorm * scale * target.excluded.weight * resolvent_norm(term);
  return factor * factor;
}

/// What one term adds to all targets, and the error that its inversion may have
/// made in a target that is not amplified.
struct TermResult {
  std::vector<double> values;
  double rounding = 0.0;
};

template <class Scalar>
TermResult evaluate_term(const FrontalMatrix& matrix, const FrontQueries& queries,
                         std::span<const HeatTarget> targets, const PartialFraction& term,
                         double scale, Scalar shift, Scalar residue) {
  // An inverse's entries err by about the residual times its norm; the residual
  // is seen on the diagonal only.
  constexpr double kUnseen = 8.0;
  constexpr double kUnit = std::numeric_limits<double>::epsilon();
  const double conjugates = is_real(term) ? 1.0 : 2.0;
  std::vector<SelectedEntries<Scalar>> entries(targets.size());
  const auto quality = selected_entries<Scalar>(matrix, queries, scale, shift, entries);
  TermResult result;
  result.values.reserve(targets.size());
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const Scalar value = residue * quadratic_form(targets[k], entries[k], scale);
    result.values.push_back(conjugates * std::real(value));
  }
  result.rounding = kUnseen * conjugates * std::abs(residue) * resolvent_norm(term) *
                    std::max(quality.residual, 4.0 * kUnit);
  if (!quality.finite) result.rounding = std::numeric_limits<double>::infinity();
  return result;
}

TermResult evaluate_term(const FrontalMatrix& matrix, const FrontQueries& queries,
                         std::span<const HeatTarget> targets, const PartialFraction& term,
                         double scale) {
  if (is_real(term)) {
    return evaluate_term<double>(matrix, queries, targets, term, scale, term.shift.real(),
                                 term.residue.real());
  }
  return evaluate_term<std::complex<double>>(matrix, queries, targets, term, scale, term.shift,
                                             term.residue);
}

CertifiedValue bracket(double value, double radius, double largest) {
  if (!std::isfinite(value) || !std::isfinite(radius)) return {0.5 * largest, 0.0, largest};
  CertifiedValue result;
  result.lower = std::clamp(value - radius, 0.0, largest);
  result.upper = std::clamp(value + radius, 0.0, largest);
  result.value = std::clamp(value, result.lower, result.upper);
  return result;
}

/// Adds up the terms of one scale for one target.
CertifiedValue combine(const HeatTarget& target, std::size_t position,
                       const RationalExponential& rational, std::span<const TermResult> terms,
                       double scale) {
  const double norm = target.squared_norm();
  double value = norm * rational.constant;
  double radius = norm * rational.error;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    value += terms[k].values[position];
    radius += norm * terms[k].rounding * amplification(target, rational.terms[k], scale);
  }
  return bracket(value, radius, norm);
}

}  // namespace

const RationalExponential& rational_exponential_for(double tolerance) {
  for (const auto& rational : kRationalExponentials) {
    if (2.0 * kLargestNorm * rational.error <= kApproximationShare * tolerance) return rational;
  }
  return kRationalExponentials.back();
}

const RationalExponential& finer_than(const RationalExponential& rational) {
  return &rational == &kRationalExponentials.back() ? rational : *(&rational + 1);
}

double rational_cost(const FrontalMatrix& matrix, const RationalExponential& rational) {
  // Fitted to measurements on pose graphs and meshes of 10^4 to 10^6 vertices.
  constexpr double kEntry = 100.0;
  constexpr double kFlop = 1.5;
  constexpr double kComplex = 2.5;
  const double one = kEntry * matrix.entries + kFlop * matrix.flops;
  double cost = 0.0;
  for (const auto& term : rational.terms) cost += is_real(term) ? one : kComplex * one;
  return cost;
}

void rational_heat(const FrontalMatrix& matrix, const FrontQueries& queries,
                   std::span<const HeatTarget> targets, const RationalExponential& rational,
                   std::span<const double> scales, int threads, const ProgressCallback& progress,
                   std::span<CertifiedValue> values) {
  const auto term_count = rational.terms.size();
  std::vector<TermResult> terms(scales.size() * term_count);
  parallel_for(
      static_cast<std::int64_t>(terms.size()), 1, threads, progress, "heat distances",
      [] { return 0; },
      [&](int, std::int64_t task) {
        const auto index = static_cast<std::size_t>(task);
        terms[index] = evaluate_term(matrix, queries, targets, rational.terms[index % term_count],
                                     scales[index / term_count]);
      });

  for (std::size_t s = 0; s < scales.size(); ++s) {
    const std::span<const TermResult> of_scale(terms.data() + s * term_count, term_count);
    for (const auto& query : queries.queries) {
      const auto position = static_cast<std::size_t>(query.pair);
      values[s * targets.size() + position] =
          combine(targets[position], position, rational, of_scale, scales[s]);
    }
  }
}

}  // namespace isotherm::spectral::detail
