#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam {

/// How trustworthy the information matrices of one kind of edge look.
struct InformationHealth {
  std::uint64_t edges = 0;
  std::uint64_t singular = 0;      ///< with a direction about which they say nothing
  std::uint64_t off_diagonal = 0;  ///< with an entry beside the diagonal
  std::uint64_t distinct = 0;      ///< different matrices; 1: all the same
  /// Largest condition number after scaling to a unit diagonal, among those that
  /// are not singular; 1 for diagonal matrices.
  double worst_condition = 1.0;
  double median_translation_sigma = 0.0;  ///< metres, root mean square over the axes
  double median_rotation_sigma = 0.0;     ///< radians, likewise
};

/// How far the file's vertices are from the chain of odometry, each chain laid on
/// the first of its vertices.
struct OdometryDrift {
  double path_length = 0.0;      ///< metres along odometry
  double mean_distance = 0.0;    ///< metres, over all vertices
  double max_distance = 0.0;     ///< metres
  double end_distance = 0.0;     ///< metres, at the last vertex
  double end_rotation = 0.0;     ///< radians, at the last vertex
  std::uint64_t max_vertex = 0;  ///< id of the vertex with the largest distance
};

/// Something that is allowed but rarely meant.
struct Suspicion {
  std::string kind;        ///< e.g. "repeated pair"
  std::uint64_t line = 0;  ///< of the edge; 0 if it concerns no single line
  std::string message;
};

/// What a pose graph holds.
struct GraphSummary {
  int dimension = 0;
  std::uint64_t vertices = 0;
  std::uint64_t edges = 0;
  std::uint64_t odometry = 0;           ///< as edge_roles counts
  std::uint64_t candidates = 0;         ///< every other edge
  std::uint64_t consecutive_edges = 0;  ///< ends differ by 1, repeats included
  std::uint64_t other_edges = 0;        ///< every other edge
  std::uint64_t repeated_edges = 0;     ///< beyond the first of their pair, in either direction
  std::uint64_t exact_repeats = 0;      ///< of these, those equal to the last digit
  std::uint64_t self_edges = 0;
  std::uint64_t fixed = 0;
  std::uint64_t robots = 0;  ///< by PoseGraph::robot()
  bool has_poses = false;
  std::uint64_t components = 0;
  std::uint64_t largest_component = 0;  ///< vertices in it
  std::uint64_t isolated_vertices = 0;
  std::uint64_t odometry_chains = 0;
  InformationHealth odometry_information;
  InformationHealth candidate_information;
  std::optional<OdometryDrift> drift;  ///< absent where the graph has no poses

  /// So many suspicions of a kind are kept; further ones are only counted.
  static constexpr std::uint64_t kKeptPerKind = 20;
  std::map<std::string, std::uint64_t> suspicious;  ///< by kind
  std::vector<Suspicion> suspicions;
};

/// O(m log m).
template <class Pose>
GraphSummary summarize(const PoseGraph<Pose>& graph);

}  // namespace isotherm::slam
