#pragma once

#include "prune/consensus/climb/assessment.hpp"

namespace isotherm::slam::detail {

/// How accurate the measurements of an explanation turn out to be.
struct Lesson {
  CovarianceScale scale;
  double rotation = 1.0;  ///< Explanation::rotation
  ScaleShares shares;
  double gain = 0.0;  ///< of evidence, with the residuals held
};

/// The factors on the covariances of odometry and of loops, and the ratio of rotation's to
/// translation's among loops, at which the evidence is highest, to first order: variance
/// components (Helmert), cost over redundancy, drawn towards the file by log_scale_prior(). And
/// the shares of loops as accurate as most and as stated under which the residuals are likeliest
/// (expectation maximisation).
template <class Pose>
Lesson learn(const Assessment<Pose>& assessment, const Explanation<Pose>& explanation);

}  // namespace isotherm::slam::detail
