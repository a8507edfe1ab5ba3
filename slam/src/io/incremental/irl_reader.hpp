#pragma once

#include <optional>
#include <string_view>

#include "io/graph_draft.hpp"

namespace isotherm::slam::detail {

/// What the header of an IRL file says.
struct IrlHeader {
  static constexpr int kLines = 5;
  int dimension = 0;  ///< of its poses, 2 or 3
};

/// The header, if these are the first lines of an IRL file: its third says the dimension, its
/// fourth `linear` or `nonlinear`.
std::optional<IrlHeader> irl_header(std::string_view text);

/// Reads the lines of an IRL file after its header, one an entry.
class IrlEntries {
 public:
  /// All must outlive this object.
  IrlEntries(TextReader& text, IrlHeader header, const ReadOptions& options, FileDraft& draft);

  /// The present line. @throws ParseError
  void read();

 private:
  template <class Pose, class ReadPose>
  void edge(GraphDraft<Pose>& draft, const ReadPose& read_pose, bool loop);
  template <class Matrix>
  Matrix information();

  TextReader& text_;
  IrlHeader header_;
  const ReadOptions& options_;
  FileDraft& draft_;
};

/// Reads a whole IRL file. @throws ParseError
FileDraft read_irl(TextReader& text, const ReadOptions& options);

}  // namespace isotherm::slam::detail
