#pragma once

#include <concepts>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "isotherm/base/range.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"

/// Pose graphs with known truth: a path through one of four worlds, one metre a
/// step, measured with noise. Each is deterministic in its options, and its
/// information matrices state the noise that was used. O(poses + loops).
namespace isotherm::slam {

/// A pose graph with the truth it was made from.
template <class Pose>
struct Simulation {
  PoseGraph<Pose> graph;    ///< noisy measurements; poses are chained odometry
  std::vector<Pose> truth;  ///< exact poses, one a vertex; the first is the identity
};

/// How a path is measured: odometry between successive poses, and loop closures
/// between random pairs of poses that are close in the world but not along the
/// path. Fewer loops than asked for are made where the path offers no more pairs.
struct MeasurementOptions {
  std::int64_t loops = -1;             ///< correct loop closures; -1: half as many as poses
  double odometry_sigma = 0.02;        ///< metres per step and axis, standard deviation, > 0
  double odometry_turn_sigma = 0.002;  ///< radians per step and axis, > 0
  double loop_sigma = 0.05;            ///< metres an axis, > 0
  double loop_turn_sigma = 0.01;       ///< radians an axis, > 0
  double loop_radius = 1.5;            ///< metres between the poses a loop joins, > 0
  /// Metres by which chained odometry misses the true end of the path: both
  /// odometry sigmas are scaled until it does. 0 keeps the sigmas as they are.
  double drift = 0.0;

  void validate() const;
};

/// A robot that drives along the streets of a square city and turns at random at
/// the crossings (after the Manhattan worlds of E. Olson, J. Leonard, S. Teller,
/// "Fast Iterative Alignment of Pose Graphs with Poor Initial Estimates", 2006).
struct CityOptions {
  std::int64_t poses = 3500;  ///< in [1, 10^7]
  std::int64_t block = 4;     ///< metres between crossings, >= 1
  MeasurementOptions measurements;
  std::uint64_t seed = 0;

  void validate() const;
};

/// A vehicle in a three-dimensional city, which also turns up and down.
struct Grid3dOptions {
  std::int64_t poses = 3500;  ///< in [1, 10^7]
  std::int64_t block = 2;     ///< metres between crossings, >= 1
  MeasurementOptions measurements;
  std::uint64_t seed = 0;

  void validate() const;
};

/// A robot that drives laps of one circle.
struct RingOptions {
  std::int64_t poses = 1000;  ///< in [1, 10^7]
  std::int64_t laps = 2;      ///< >= 1; the circle's radius follows
  MeasurementOptions measurements;
  std::uint64_t seed = 0;

  void validate() const;
};

/// A vehicle that spirals over a sphere from one pole to the other, level with
/// the surface.
struct SphereOptions {
  std::int64_t poses = 2500;  ///< in [1, 10^7]
  /// Turns around the axis, the radius follows; 0: as many as put neighbouring
  /// turns one metre apart.
  std::int64_t laps = 0;
  MeasurementOptions measurements;
  std::uint64_t seed = 0;

  void validate() const;
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, MeasurementOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("loops", options.loops, "correct loop closures; -1: half as many as poses",
        closed(-1, 1e7));
  visit("odometry_sigma", options.odometry_sigma, "odometry noise, metres per step",
        closed(1e-9, 1e6));
  visit("odometry_turn_sigma", options.odometry_turn_sigma, "odometry noise, radians per step",
        closed(1e-9, 1e6));
  visit("loop_sigma", options.loop_sigma, "loop closure noise, metres", closed(1e-9, 1e6));
  visit("loop_turn_sigma", options.loop_turn_sigma, "loop closure noise, radians",
        closed(1e-9, 1e6));
  visit("loop_radius", options.loop_radius, "largest distance of the poses a loop joins, metres",
        left_open(0, 1e6));
  visit("drift", options.drift,
        "metres by which odometry misses the end of the path (scales its noise); 0: as it comes",
        closed(0, 1e9));
}

template <class Options, class Visitor>
requires(
    std::same_as<std::remove_const_t<Options>, CityOptions> ||
    std::same_as<std::remove_const_t<Options>, Grid3dOptions>) void visit_fields(Options& options,
                                                                                 Visitor&& visit) {
  visit("poses", options.poses, "number of poses, one metre apart", closed(1, 1e7));
  visit("block", options.block, "metres between street crossings", closed(1, 1e6));
  visit_fields(options.measurements, visit);
}

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, RingOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("poses", options.poses, "number of poses, one metre apart", closed(1, 1e7));
  visit("laps", options.laps, "times around the circle", closed(1, 1e6));
  visit_fields(options.measurements, visit);
}

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, SphereOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("poses", options.poses, "number of poses, about one metre apart", closed(1, 1e7));
  visit("laps", options.laps, "turns around the axis; 0: neighbouring turns one metre apart",
        closed(0, 1e6));
  visit_fields(options.measurements, visit);
}

/// @throws InvalidArgument for options out of range (all of them)
Simulation<Pose2> simulate_city(const CityOptions& options);
Simulation<Pose3> simulate_grid3d(const Grid3dOptions& options);
Simulation<Pose2> simulate_ring(const RingOptions& options);
Simulation<Pose3> simulate_sphere(const SphereOptions& options);

}  // namespace isotherm::slam
