#pragma once

#include "isotherm/spectral/types.hpp"

namespace isotherm::spectral::detail {

constexpr Index kNoVertex = -1;
constexpr double kLargestNorm = 2.0;  ///< squared, of a target's vector

/// An edge that is to be thought away: `weight` is its own, `remaining` that of
/// its parallel edges together.
struct ExcludedEdge {
  Index from = kNoVertex;
  Index to = kNoVertex;
  double weight = 0.0;
  double remaining = 0.0;

  bool any() const { return from != kNoVertex; }
};

/// A quadratic form x' exp(-tL) x to evaluate: x = e_from - e_to, or e_from
/// alone if `to` is kNoVertex; L without the excluded edge, if there is one, of
/// which `from` is an end.
struct HeatTarget {
  Index from = kNoVertex;
  Index to = kNoVertex;
  ExcludedEdge excluded = {};

  bool single() const { return to == kNoVertex; }
  bool trivial() const { return from == to; }
  double squared_norm() const { return single() ? 1.0 : kLargestNorm; }
};

}  // namespace isotherm::spectral::detail
