#pragma once

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "isotherm/slam/graph/pose_graph.hpp"

namespace isotherm::slam {

/// What one line of a stream says.
template <class Pose>
struct StreamVertex {
  VertexId id = 0;
  Pose pose;
};
template <class Pose>
struct StreamEdge {
  VertexId from = 0;
  VertexId to = 0;
  Constraint<Pose> measured;         ///< its ends are not set
  std::optional<bool> correct = {};  ///< whether it is true, where the stream says so
};
struct StreamFixed {
  VertexId id = 0;
};
using StreamEntry = std::variant<StreamVertex<Pose2>, StreamVertex<Pose3>, StreamEdge<Pose2>,
                                 StreamEdge<Pose3>, StreamFixed>;

/// Reads a pose graph entry by entry, as it comes: g2o, TORO or IRL, lines in order of time.
/// Not a line more is taken from the stream than an entry needs, but for the first five, by
/// which the format is told. JRL is read to its end first, since it has one robot behind the other,
/// and replayed in order of time.
class PoseGraphStream {
 public:
  /// `in` must outlive this object; `name` stands for it in messages.
  PoseGraphStream(std::istream& in, std::string name);
  ~PoseGraphStream();
  PoseGraphStream(PoseGraphStream&&) noexcept;
  PoseGraphStream& operator=(PoseGraphStream&&) noexcept;

  /// The next entry; none at the end. Comments and records of other kinds are passed over.
  /// @throws ParseError for a line that is malformed, or information that is not positive
  ///   semi-definite
  std::optional<StreamEntry> next();

  /// Of the last entry, from 1.
  std::uint64_t line_number() const;

 private:
  class Reader;
  std::unique_ptr<Reader> reader_;
};

}  // namespace isotherm::slam
