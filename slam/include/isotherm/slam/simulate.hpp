#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "isotherm/slam/pose_graph.hpp"

namespace isotherm::slam {

/// A pose graph with the truth it was made from.
template <class Pose>
struct Simulation {
  PoseGraph<Pose> graph;    ///< noisy measurements; poses are chained odometry
  std::vector<Pose> truth;  ///< exact poses, one a vertex; the first is the identity
};

/// A robot that drives one metre at a time along the streets of a square city
/// block grid and turns at random at the crossings (after the Manhattan worlds of
/// E. Olson, J. Leonard, S. Teller, "Fast Iterative Alignment of Pose Graphs with
/// Poor Initial Estimates", 2006).
struct CityOptions {
  std::int64_t poses = 3500;           ///< >= 1
  std::int64_t loops = -1;             ///< correct loop closures; -1: half as many as poses
  std::int64_t block = 4;              ///< metres between crossings, >= 1
  double odometry_sigma = 0.02;        ///< metres per step, standard deviation, > 0
  double odometry_turn_sigma = 0.002;  ///< radians per step, > 0
  double loop_sigma = 0.05;            ///< metres, > 0
  double loop_turn_sigma = 0.01;       ///< radians, > 0
  double loop_radius = 1.5;            ///< metres between the poses a loop joins, > 0
  /// Metres by which chained odometry misses the true end of the path: both
  /// odometry sigmas are scaled until it does. 0 keeps the sigmas as they are.
  double drift = 0.0;
  std::uint64_t seed = 0;

  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, CityOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("poses", options.poses, "number of poses, one metre apart");
  visit("loops", options.loops, "correct loop closures; -1: half as many as poses");
  visit("block", options.block, "metres between street crossings");
  visit("odometry_sigma", options.odometry_sigma, "odometry noise, metres per step");
  visit("odometry_turn_sigma", options.odometry_turn_sigma, "odometry noise, radians per step");
  visit("loop_sigma", options.loop_sigma, "loop closure noise, metres");
  visit("loop_turn_sigma", options.loop_turn_sigma, "loop closure noise, radians");
  visit("loop_radius", options.loop_radius, "largest distance of the poses a loop joins, metres");
  visit("drift", options.drift,
        "metres by which odometry misses the end of the path (scales its noise); 0: as it comes");
}

/// Deterministic in the options. The information matrices state the noise that
/// was used. Fewer loops than asked for are made where the path offers no more
/// pairs. O(poses + loops).
/// @throws InvalidArgument for options out of range
Simulation<Pose2> simulate_city(const CityOptions& options);

}  // namespace isotherm::slam
