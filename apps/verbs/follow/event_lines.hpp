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

  /// `at` is the number of the edge that brought it.
  void tell(const slam::LoopChange& change, std::uint64_t at);
  void end(const spectral::EdgeVerdicts& verdicts, std::uint64_t edges);

 private:
  void write(const std::string& line);

  std::string path_;
  std::ofstream file_;
  std::ostream* out_ = nullptr;
};

}  // namespace isotherm::apps
