#pragma once

#include "prune/consensus/estimate/estimate.hpp"
#include "prune/consensus/estimate/map_volume.hpp"
#include "prune/consensus/estimate/reduced_graph.hpp"

namespace isotherm::slam::detail {

// What a graph says about one of its loops. In all of these `r` is the loop's residual
// under the estimate, `C` the covariance of T_a^-1 T_b there, `loop_scale` the factor
// on the covariance that the file states for the loop.

/// How a loop compares with the prediction of the others, which C is of.
template <class Pose>
Evidence weigh_prediction(const Link<Pose>& loop, const typename Pose::Tangent& r,
                          const typename Pose::Matrix& C, double loop_scale,
                          const MapVolume<Pose>& map);

/// Chi-squared of an accepted loop, whose own measurement C includes, against the
/// prediction of all others: with P the fitted covariance r' (Sigma - P)^-1 r. Along
/// directions that only this loop measures, Sigma - P and r both vanish.
template <class Pose>
double fitted_chi2(const Link<Pose>& loop, const typename Pose::Tangent& r,
                   const typename Pose::Matrix& C, double loop_scale);

/// How an accepted loop, whose own measurement C includes, compares with the prediction
/// of all others.
template <class Pose>
Evidence weigh_held_out(const Link<Pose>& loop, const typename Pose::Tangent& r,
                        const typename Pose::Matrix& C, double loop_scale,
                        const MapVolume<Pose>& map);

/// C once the loop itself is accepted: C - C (C + Sigma)^-1 C.
template <class Pose>
typename Pose::Matrix sharpened(const Link<Pose>& loop, const typename Pose::Tangent& r,
                                const typename Pose::Matrix& C, double loop_scale);

}  // namespace isotherm::slam::detail
