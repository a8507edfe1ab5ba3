#pragma once

#include <limits>
#include <vector>

#include "isotherm/network/localize/range_mixture.hpp"
#include "localize/problem/absence.hpp"
#include "localize/problem/map_task.hpp"

/// The objective: twice the log of how likely a map is.
namespace isotherm::network::detail {

/// What a range costs by how far its ends are off, beside a correct one without error: twice the
/// log of the ratio of densities, the range being of the kind that is likeliest there (E. Olson, P.
/// Agarwal, "Inference on networks of mixtures for robust robot mapping", 2013).
struct RangeCost {
  double anything = 0.0;  ///< where nothing is left of the correct kind; the most there is
  double too_long = std::numeric_limits<double>::infinity();  ///< the same of an excess of 0
  double per_sigma = 0.0;                                     ///< more for a longer one

  /// Of (distance of the ends - range) / sigma.
  double operator()(double residual) const;

  /// How far ends may be apart, or too close, before that costs so much; infinite if never.
  double apart_at(double cost) const;
  double close_at(double cost) const;
};

/// What speaks for and against places, as learned from a map.
struct Evidence {
  RangeMixture model;
  Absence absence;

  RangeCost cost_of(double sigma) const;
};

/// Before anything is known of the kinds of range. What can be any length is as long as the map, or
/// as the longest range if that is longer.
RangeMixture first_mixture(const RangeProblem& problem, const Placement& placement, bool too_long);

/// Shares of the kinds of range, and the mean excess, by expectation maximisation from the trusted
/// pairs of placed nodes; absence from these nodes.
Evidence learn_evidence(const MapTask& task, const Placement& placement);

/// Twice the log of how much likelier the trusted pairs of placed nodes, and the absence of others,
/// are on this map than ranges of any length up to the longest, times what is left of the prior of
/// its coordinates, which may be anywhere on it, within the noise of a range.
double worth(const MapTask& task, const Placement& placement);

/// The same with the evidence learned from it already.
double worth(const MapTask& task, const Evidence& evidence, const Placement& placement);

}  // namespace isotherm::network::detail
