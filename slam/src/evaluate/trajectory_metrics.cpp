#include "isotherm/slam/evaluate/trajectory_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Geometry>

#include "isotherm/base/error.hpp"
#include "isotherm/base/statistics.hpp"
#include "matrices/nearest_rotation.hpp"

namespace isotherm::slam {
namespace {

Pose2 make_pose(const Eigen::Matrix2d& rotation, const Eigen::Vector2d& translation) {
  return {translation, std::atan2(rotation(1, 0), rotation(0, 0))};
}

Pose3 make_pose(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
  return {translation, Eigen::Quaterniond(rotation).normalized()};
}

template <class Pose>
Eigen::MatrixXd positions(const std::vector<Pose>& poses) {
  Eigen::MatrixXd columns(Pose::kDim, static_cast<Eigen::Index>(poses.size()));
  for (std::size_t k = 0; k < poses.size(); ++k) {
    columns.col(static_cast<Eigen::Index>(k)) = poses[k].translation();
  }
  return columns;
}

template <class Pose>
Pose least_squares_motion(const PosePairs<Pose>& pairs) {
  constexpr int kDim = Pose::kDim;
  Eigen::MatrixXd estimate = positions(pairs.estimate);
  Eigen::MatrixXd truth = positions(pairs.truth);
  const Eigen::VectorXd estimate_mean = estimate.rowwise().mean();
  const Eigen::VectorXd truth_mean = truth.rowwise().mean();
  estimate.colwise() -= estimate_mean;
  truth.colwise() -= truth_mean;

  const Eigen::MatrixXd covariance = truth * estimate.transpose();
  const detail::NearestRotation nearest = detail::nearest_rotation(covariance);
  // All but one singular value must be there to fix the rotation.
  const double scale = estimate.norm() * truth.norm();
  if (!(nearest.singular_values[kDim - 2] > 1e-15 * scale)) {
    throw InvalidArgument("align", "the positions leave the rotation open; use first or none");
  }
  const Eigen::Matrix<double, kDim, kDim> rotation = nearest.rotation;
  const Eigen::Matrix<double, kDim, 1> translation = truth_mean - rotation * estimate_mean;
  return make_pose(rotation, translation);
}

void require_ascending(const std::vector<double>& stamps, const char* which) {
  if (!std::is_sorted(stamps.begin(), stamps.end())) {
    throw InvalidArgument("timestamps", std::string("those of the ") + which + " go back");
  }
}

// Index of the stamp nearest to `time`; the earlier one of two as near.
std::size_t nearest(const std::vector<double>& stamps, double time) {
  const auto after = std::lower_bound(stamps.begin(), stamps.end(), time);
  if (after == stamps.begin()) return 0;
  const auto index = static_cast<std::size_t>(after - stamps.begin());
  if (after == stamps.end()) return index - 1;
  return time - stamps[index - 1] <= *after - time ? index - 1 : index;
}

}  // namespace

template <class Pose>
PosePairs<Pose> pair_poses(const std::vector<Pose>& estimate,
                           const std::vector<std::optional<Pose>>& truth) {
  if (estimate.size() != truth.size()) {
    throw InvalidArgument("truth", "has " + std::to_string(truth.size()) + " poses, the estimate " +
                                       std::to_string(estimate.size()));
  }
  PosePairs<Pose> pairs;
  for (std::size_t k = 0; k < truth.size(); ++k) {
    if (!truth[k]) continue;
    pairs.estimate.push_back(estimate[k]);
    pairs.truth.push_back(*truth[k]);
  }
  return pairs;
}

template <class Pose>
PosePairs<Pose> pair_trajectories(const Trajectory<Pose>& estimate, const Trajectory<Pose>& truth,
                                  double max_difference) {
  if (estimate.timestamps.empty() != truth.timestamps.empty()) {
    throw InvalidArgument("timestamps", "needed for both trajectories or for neither");
  }
  if (estimate.timestamps.empty()) {
    return pair_poses(estimate.poses,
                      std::vector<std::optional<Pose>>(truth.poses.begin(), truth.poses.end()));
  }
  require_ascending(estimate.timestamps, "estimate");
  require_ascending(truth.timestamps, "truth");
  PosePairs<Pose> pairs;
  const bool truth_is_longer = truth.poses.size() > estimate.poses.size();
  const auto& shorter = truth_is_longer ? estimate : truth;
  const auto& longer = truth_is_longer ? truth : estimate;
  for (std::size_t k = 0; k < shorter.poses.size() && !longer.poses.empty(); ++k) {
    const std::size_t match = nearest(longer.timestamps, shorter.timestamps[k]);
    if (std::abs(longer.timestamps[match] - shorter.timestamps[k]) > max_difference) continue;
    pairs.estimate.push_back(truth_is_longer ? shorter.poses[k] : longer.poses[match]);
    pairs.truth.push_back(truth_is_longer ? longer.poses[match] : shorter.poses[k]);
  }
  return pairs;
}

ErrorStatistics summarize(std::vector<double> errors) {
  ErrorStatistics result;
  if (errors.empty()) return result;
  std::sort(errors.begin(), errors.end());
  const Eigen::Map<const Eigen::ArrayXd> values(errors.data(),
                                                static_cast<Eigen::Index>(errors.size()));
  const std::size_t middle = errors.size() / 2;
  result.pairs = static_cast<std::int64_t>(errors.size());
  result.mean = values.mean();
  result.rmse = std::sqrt(values.square().mean());
  result.median =
      errors.size() % 2 == 1 ? errors[middle] : 0.5 * (errors[middle - 1] + errors[middle]);
  result.max = errors.back();
  result.min = errors.front();
  result.std = std::sqrt((values - result.mean).square().mean());
  return result;
}

template <class Pose>
Pose align(const PosePairs<Pose>& pairs, Alignment alignment) {
  if (pairs.estimate.empty()) throw InvalidArgument("pairs", "no estimated pose has a true one");
  switch (alignment) {
    case Alignment::first:
      return pairs.truth.front() * pairs.estimate.front().inverse();
    case Alignment::se:
      return least_squares_motion(pairs);
    case Alignment::none:
      break;
  }
  return Pose();
}

template <class Pose>
ErrorStatistics absolute_trajectory_error(const PosePairs<Pose>& pairs, Alignment alignment) {
  const Pose T = align(pairs, alignment);
  std::vector<double> errors;
  for (std::size_t k = 0; k < pairs.estimate.size(); ++k) {
    errors.push_back((T * pairs.estimate[k].translation() - pairs.truth[k].translation()).norm());
  }
  return summarize(std::move(errors));
}

void RelativeErrorOptions::validate() const { require_fields_in_range(*this); }

template <class Pose>
RelativeError relative_pose_error(const PosePairs<Pose>& pairs,
                                  const RelativeErrorOptions& options) {
  options.validate();
  const auto delta = static_cast<std::size_t>(options.delta);
  const std::size_t stride = options.all_pairs ? 1 : delta;
  std::vector<double> translation;
  std::vector<double> rotation;
  for (std::size_t k = 0; k + delta < pairs.estimate.size(); k += stride) {
    const Pose measured = pairs.estimate[k].between(pairs.estimate[k + delta]);
    const Pose expected = pairs.truth[k].between(pairs.truth[k + delta]);
    const Pose error = expected.between(measured);
    translation.push_back(error.translation().norm());
    rotation.push_back(error.rotation_angle());
  }
  return {summarize(std::move(translation)), summarize(std::move(rotation))};
}

template <class Pose>
double motion_disagreement(const PosePairs<Pose>& pairs) {
  constexpr std::size_t kStretch = 10;
  std::vector<double> shares;
  for (std::size_t k = 0; k + kStretch < pairs.estimate.size(); k += kStretch) {
    const typename Pose::Translation estimated =
        pairs.estimate[k].between(pairs.estimate[k + kStretch]).translation();
    const typename Pose::Translation expected =
        pairs.truth[k].between(pairs.truth[k + kStretch]).translation();
    const double length = std::max(estimated.norm(), expected.norm());
    if (length > 0.0) shares.push_back((estimated - expected).norm() / length);
  }
  return shares.empty() ? 0.0 : median(shares);
}

template struct PosePairs<Pose2>;
template struct PosePairs<Pose3>;
template PosePairs<Pose2> pair_poses(const std::vector<Pose2>&,
                                     const std::vector<std::optional<Pose2>>&);
template PosePairs<Pose3> pair_poses(const std::vector<Pose3>&,
                                     const std::vector<std::optional<Pose3>>&);
template PosePairs<Pose2> pair_trajectories(const Trajectory<Pose2>&, const Trajectory<Pose2>&,
                                            double);
template PosePairs<Pose3> pair_trajectories(const Trajectory<Pose3>&, const Trajectory<Pose3>&,
                                            double);
template Pose2 align(const PosePairs<Pose2>&, Alignment);
template Pose3 align(const PosePairs<Pose3>&, Alignment);
template ErrorStatistics absolute_trajectory_error(const PosePairs<Pose2>&, Alignment);
template ErrorStatistics absolute_trajectory_error(const PosePairs<Pose3>&, Alignment);
template double motion_disagreement(const PosePairs<Pose2>&);
template double motion_disagreement(const PosePairs<Pose3>&);
template RelativeError relative_pose_error(const PosePairs<Pose2>&, const RelativeErrorOptions&);
template RelativeError relative_pose_error(const PosePairs<Pose3>&, const RelativeErrorOptions&);

}  // namespace isotherm::slam
