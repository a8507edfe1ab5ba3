#include "rational_heat.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "parallel.hpp"
#include "selected_inverse.hpp"

namespace isotherm::spectral::detail {
namespace {

constexpr double kSquaredNorm = 2.0;  // of e_i - e_j
/// Share of the tolerance that the approximation may take; the rest is for rounding.
constexpr double kApproximationShare = 0.9;

/// What one term adds to the distances of all pairs, with the error that its
/// inversion may have made.
struct TermResult {
  std::vector<double> values;
  double rounding = 0.0;
};

TermResult evaluate_term(const SupernodalStructure& structure, const FrontQueries& queries,
                         const PartialFraction& term, double scale, std::size_t pair_count) {
  // An inverse's entries err by about the residual times its norm; the residual
  // is seen on the diagonal only.
  constexpr double kUnseen = 8.0;
  constexpr double kUnit = std::numeric_limits<double>::epsilon();
  TermResult result;
  SelectedInverseQuality quality;
  double conjugates = 1.0;
  if (is_real(term)) {
    result.values.resize(pair_count);
    quality =
        selected_differences<double>(structure, queries, scale, term.shift.real(), result.values);
    for (double& value : result.values) value *= term.residue.real();
  } else {
    conjugates = 2.0;
    std::vector<std::complex<double>> values(pair_count);
    quality =
        selected_differences<std::complex<double>>(structure, queries, scale, term.shift, values);
    result.values.reserve(pair_count);
    for (const auto& value : values) result.values.push_back(2.0 * (term.residue * value).real());
  }
  result.rounding = kUnseen * conjugates * kSquaredNorm * std::abs(term.residue) *
                    resolvent_norm(term) * std::max(quality.residual, 4.0 * kUnit);
  if (!quality.finite) result.rounding = std::numeric_limits<double>::infinity();
  return result;
}

CertifiedValue bracket(double value, double radius) {
  if (!std::isfinite(value) || !std::isfinite(radius)) return {1.0, 0.0, kSquaredNorm};
  CertifiedValue result;
  result.lower = std::clamp(value - radius, 0.0, kSquaredNorm);
  result.upper = std::clamp(value + radius, 0.0, kSquaredNorm);
  result.value = std::clamp(value, result.lower, result.upper);
  return result;
}

}  // namespace

const RationalExponential& rational_exponential_for(double tolerance) {
  for (const auto& rational : kRationalExponentials) {
    if (2.0 * kSquaredNorm * rational.error <= kApproximationShare * tolerance) return rational;
  }
  return kRationalExponentials.back();
}

double rational_cost(const SupernodalStructure& structure, const RationalExponential& rational) {
  // Fitted to measurements on pose graphs and meshes of 10^4 to 10^6 vertices.
  constexpr double kEntry = 100.0;
  constexpr double kFlop = 1.5;
  constexpr double kComplex = 2.5;
  const double one = kEntry * structure.entries + kFlop * structure.flops;
  double cost = 0.0;
  for (const auto& term : rational.terms) cost += is_real(term) ? one : kComplex * one;
  return cost;
}

void rational_heat_distances(const SupernodalStructure& structure, const FrontQueries& queries,
                             const RationalExponential& rational, std::span<const double> scales,
                             int threads, const ProgressCallback& progress,
                             std::span<CertifiedValue> values) {
  if (scales.empty()) return;
  const auto pair_count = values.size() / scales.size();
  const auto term_count = rational.terms.size();
  std::vector<TermResult> terms(scales.size() * term_count);
  parallel_for(
      static_cast<std::int64_t>(terms.size()), 1, threads, progress, "heat distances",
      [] { return 0; },
      [&](int, std::int64_t task) {
        const auto index = static_cast<std::size_t>(task);
        terms[index] = evaluate_term(structure, queries, rational.terms[index % term_count],
                                     scales[index / term_count], pair_count);
      });

  for (std::size_t s = 0; s < scales.size(); ++s) {
    const std::span of_scale(terms.data() + s * term_count, term_count);
    double radius = kSquaredNorm * rational.error;
    for (const auto& term : of_scale) radius += term.rounding;
    for (const auto& query : queries.queries) {
      double value = kSquaredNorm * rational.constant;
      for (const auto& term : of_scale) value += term.values[query.pair];
      values[s * pair_count + query.pair] = bracket(value, radius);
    }
  }
}

}  // namespace isotherm::spectral::detail
