#pragma once

#include <functional>
#include <iosfwd>

#include "online/edge_log.hpp"

namespace isotherm::slam::detail {

/// How much of an edge log is written.
struct Written {
  std::size_t poses = 0;
  std::size_t fixed = 0;
  std::size_t edges = 0;
  bool header = false;
};

/// Writes what an edge log holds beyond `written` as lines of text, with numbers that read back to
/// the last bit, and counts it in.
template <class Pose>
void write_edges(std::ostream& out, const EdgeLog<Pose>& log, Written& written);

/// Told what write_edges() wrote, in that order.
template <class Pose>
struct EdgeReader {
  std::function<void(VertexId, const Pose&)> pose;
  std::function<void(VertexId)> fixed;
  std::function<void(const typename EdgeLog<Pose>::Edge&)> edge;
};

/// @throws ParseError naming the line
template <class Pose>
void read_edges(std::istream& in, const EdgeReader<Pose>& reader);

}  // namespace isotherm::slam::detail
