#pragma once

#include <span>

#include "heat/heat_target.hpp"
#include "heat/rational_exponential_table.hpp"
#include "isotherm/base/progress.hpp"
#include "isotherm/spectral/heat/heat_distance.hpp"
#include "sparse/inverse/frontal_matrix.hpp"

namespace isotherm::spectral::detail {

/// The cheapest rational approximation whose error leaves a heat distance's
/// bracket narrower than `tolerance`; the most accurate one if none does.
const RationalExponential& rational_exponential_for(double tolerance);

/// The one that is next in accuracy; the same if there is none.
const RationalExponential& finer_than(const RationalExponential& rational);

/// Rough time of all factorisations and inversions that one scale takes, in
/// nanoseconds on one thread. Counted, not measured: the same on every machine.
double rational_cost(const FrontalMatrix& matrix, const RationalExponential& rational);

/// The targets at every scale through exp(-x) = constant + sum_k residue_k /
/// (x + shift_k), one selected inversion of scale * L + shift_k * I a term. An
/// excluded edge is a rank-one change of each inverse (Sherman and Morrison).
///
/// `queries` holds for each target its pair of ends, or those of its excluded
/// edge; `values` is scales x targets, of which those queried are written. A
/// bracket's width is twice the approximation's uniform error (on [0, infinity),
/// hence for any spectrum) plus an allowance for rounding, made from the
/// residual of every inversion. Where a factorisation broke down it says nothing.
/// @throws Cancelled.
void rational_heat(const FrontalMatrix& matrix, const FrontQueries& queries,
                   std::span<const HeatTarget> targets, const RationalExponential& rational,
                   std::span<const double> scales, int threads, const ProgressCallback& progress,
                   std::span<CertifiedValue> values);

}  // namespace isotherm::spectral::detail
