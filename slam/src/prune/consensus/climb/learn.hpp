#pragma once

#include "prune/consensus/climb/assessment.hpp"

namespace isotherm::slam::detail {

/// How accurate the measurements of an explanation turn out to be.
template <class Pose>
struct Lesson {
  CovarianceScale scale;
  Shapes<Pose> shapes;
  ScaleShares shares;
  double gain = 0.0;  ///< of evidence, with the residuals held
};

/// The factors on the covariances of odometry, of loops and of each of their coordinates at which
/// the evidence is highest, to first order: variance components (Helmert), cost over redundancy,
/// drawn towards the file by their prior (scale_prior.hpp). And the shares of loops as accurate as
/// most and less under which the residuals are likeliest (expectation maximisation, from what
/// is believed and from the scale above or below called that of most: it ends at the nearest peak).
/// To first order in the logs, so that with far other shapes a lesson may be worse: `same_shapes`
/// learns factors on all coordinates alone.
template <class Pose>
Lesson<Pose> learn(const Assessment<Pose>& assessment, const Explanation<Pose>& explanation,
                   bool same_shapes);

}  // namespace isotherm::slam::detail
