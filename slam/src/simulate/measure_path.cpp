#include "simulate/measure_path.hpp"

#include <cmath>

#include "isotherm/slam/graph/odometry.hpp"
#include "simulate/loop_pairs.hpp"

namespace isotherm::slam::detail {
namespace {

template <class Pose>
using Tangents = std::vector<typename Pose::Tangent>;

template <class Pose>
typename Pose::Tangent sigmas(double translation, double rotation) {
  typename Pose::Tangent sigma;
  sigma.template head<Pose::kDim>().setConstant(translation);
  sigma.template tail<Pose::kDof - Pose::kDim>().setConstant(rotation);
  return sigma;
}

template <class Pose>
Constraint<Pose> measure(const std::vector<Pose>& truth, const LoopPair& pair,
                         const typename Pose::Tangent& unit, const typename Pose::Tangent& sigma) {
  Constraint<Pose> constraint;
  constraint.from = pair.from;
  constraint.to = pair.to;
  constraint.T_from_to =
      truth[pair.from].between(truth[pair.to]) * Pose::exp(sigma.cwiseProduct(unit));
  constraint.information = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  return constraint;
}

template <class Pose>
Constraint<Pose> measure_step(const std::vector<Pose>& truth, std::size_t step,
                              const typename Pose::Tangent& unit,
                              const typename Pose::Tangent& sigma) {
  const auto from = static_cast<Index>(step);
  return measure(truth, {from, from + 1}, unit, sigma);
}

template <class Pose>
double end_error(const std::vector<Pose>& truth, const Tangents<Pose>& noise,
                 const typename Pose::Tangent& sigma) {
  Pose end = truth.front();
  for (std::size_t k = 0; k < noise.size(); ++k) {
    end = end * measure_step(truth, k, noise[k], sigma).T_from_to;
  }
  return (end.translation() - truth.back().translation()).norm();
}

// The factor on the noise with which the end of the path is missed by `drift`.
// The error is continuous in the factor and zero at zero, so that growing the
// factor brackets a solution, which bisection then finds.
template <class Pose>
double scale_for_drift(const std::vector<Pose>& truth, const Tangents<Pose>& noise,
                       const typename Pose::Tangent& sigma, double drift) {
  double low = 0.0;
  double high = 1e-3;
  while (end_error(truth, noise, high * sigma) < drift) {
    low = high;
    high *= 1.25;
    if (high > 1e4) throw InvalidArgument("drift", "this path cannot drift so far");
  }
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (end_error(truth, noise, middle * sigma) < drift ? low : high) = middle;
  }
  return high;
}

template <class Pose>
std::vector<Eigen::Vector3d> places(const std::vector<Pose>& path) {
  std::vector<Eigen::Vector3d> result(path.size(), Eigen::Vector3d::Zero());
  for (std::size_t k = 0; k < path.size(); ++k) {
    result[k].template head<Pose::kDim>() = path[k].translation();
  }
  return result;
}

}  // namespace

template <class Pose>
Simulation<Pose> measure_path(std::vector<Pose> path, const MeasurementOptions& options,
                              Random& random) {
  const Pose to_start = path.front().inverse();
  for (auto& pose : path) pose = to_start * pose;

  Simulation<Pose> simulation;
  simulation.truth = std::move(path);
  const auto& truth = simulation.truth;
  auto& graph = simulation.graph;
  for (std::size_t k = 0; k < truth.size(); ++k) graph.ids.push_back(k);

  Tangents<Pose> noise;
  for (std::size_t k = 1; k < truth.size(); ++k)
    noise.push_back(random.normal_vector<typename Pose::Tangent>());
  auto sigma = sigmas<Pose>(options.odometry_sigma, options.odometry_turn_sigma);
  if (options.drift > 0.0) sigma *= scale_for_drift(truth, noise, sigma, options.drift);
  for (std::size_t k = 0; k < noise.size(); ++k) {
    graph.constraints.push_back(measure_step(truth, k, noise[k], sigma));
  }
  graph.poses = odometry_poses(graph, edge_roles(graph));

  const auto loop_sigma = sigmas<Pose>(options.loop_sigma, options.loop_turn_sigma);
  const auto loops =
      options.loops < 0 ? static_cast<std::int64_t>(truth.size() / 2) : options.loops;
  for (const auto& pair : loop_pairs(places(truth), loops, options.loop_radius, random)) {
    graph.constraints.push_back(
        measure(truth, pair, random.normal_vector<typename Pose::Tangent>(), loop_sigma));
  }
  return simulation;
}

template Simulation<Pose2> measure_path(std::vector<Pose2>, const MeasurementOptions&, Random&);
template Simulation<Pose3> measure_path(std::vector<Pose3>, const MeasurementOptions&, Random&);

}  // namespace isotherm::slam::detail

namespace isotherm::slam {

void MeasurementOptions::validate() const { require_fields_in_range(*this); }

}  // namespace isotherm::slam
