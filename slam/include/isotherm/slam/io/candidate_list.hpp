#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "isotherm/base/options.hpp"
#include "isotherm/base/range.hpp"
#include "isotherm/base/text_reader.hpp"
#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam {

/// Two poses that place recognition takes for the same place.
struct PlacePair {
  VertexId from = 0;
  VertexId to = 0;
  std::uint64_t rank = 0;  ///< among those of the same query, best first, from 0
  std::uint64_t line = 0;
  std::vector<double> transform;  ///< x y theta, or x y z qx qy qz qw; empty if not known
};

/// Reads what place recognition gives: rows of a query and the poses that look like it, best
/// first, separated by blanks or commas; or rows with column names `from,to`, and, where
/// they are known, `x,y,theta` or `x,y,z,qx,qy,qz,qw`, the pose of `to` in the frame of `from`.
/// Other columns, such as a score, are not used.
/// @throws FileError, ParseError
std::vector<PlacePair> read_place_pairs(const std::string& path);

/// What pairs become as constraints.
struct PlaceOptions {
  double sigma = 5.0;            ///< metres an axis of a transform that is not known: near identity
  double turn_sigma = 0.0;       ///< radians of it; 0: nothing is known of how the two look
  double transform_sigma = 0.1;  ///< metres of a transform that is
  double transform_turn_sigma = 0.02;  ///< radians of it
  std::int64_t top = 0;                ///< the best of each query that are taken; 0: all
  std::int64_t min_gap = 2;            ///< poses between the two, at least

  void validate() const { require_fields_in_range(*this); }
};

template <class Options, class Visitor>
requires std::same_as<std::remove_const_t<Options>, PlaceOptions>
void visit_fields(Options& options, Visitor&& visit) {
  visit("sigma", options.sigma, "metres within which two poses of one place lie, where that is all",
        closed(1e-6, 1e6));
  visit("turn_sigma", options.turn_sigma,
        "radians within which they look the same way; 0: nothing is known", closed(0, 10));
  visit("transform_sigma", options.transform_sigma, "metres, where a transform is given",
        closed(1e-6, 1e6));
  visit("transform_turn_sigma", options.transform_turn_sigma, "radians, where one is given",
        closed(1e-6, 10));
  visit("top", options.top, "the best of each query to take; 0: all", closed(0, 1e6));
  visit("min_gap", options.min_gap, "fewest poses between the two", closed(1, 1e7));
}

/// Adds a constraint a pair to `graph`; gives back how many were left out, as too near or
/// not among the best.
/// @throws ParseError for a pose that the graph does not have, or a transform of another
///   dimension; `path` names the list
template <class Pose>
std::uint64_t add_place_pairs(PoseGraph<Pose>& graph, const std::vector<PlacePair>& pairs,
                              const PlaceOptions& options, const std::string& path);

}  // namespace isotherm::slam
