#pragma once

#include <cstdint>
#include <fstream>
#include <ostream>
#include <string>

#include "isotherm/slam/online/online_consensus.hpp"

namespace isotherm::apps {

/// Writes one JSON line an event, each as soon as it is known.
class EventLines {
 public:
  /// @param path "-" for stdout, empty for none. @throws FileError
  explicit EventLines(const std::string& path);

  /// When an event was: the number of the edge that brought it, and of poses that had come.
  struct Time {
    std::uint64_t at = 0;
    std::uint64_t poses = 0;
  };

  void tell(const slam::LoopChange& change, Time time);
  /// How far the estimate is from the truth.
  void error(double ate, Time time);
  void end(const spectral::EdgeVerdicts& verdicts, Time time);

 private:
  void write(const std::string& line);

  std::string path_;
  std::ofstream file_;
  std::ostream* out_ = nullptr;
};

}  // namespace isotherm::apps
