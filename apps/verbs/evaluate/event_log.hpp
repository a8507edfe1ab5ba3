#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "isotherm/slam/evaluate/evaluate_online.hpp"

namespace isotherm::apps {

/// What `follow` wrote while a graph came in.
struct EventLog {
  /// How far the map was from the truth at one time.
  struct Error {
    std::int64_t at = 0;
    std::int64_t poses = 0;
    double ate = 0.0;
  };

  std::vector<slam::TimedVerdict> verdicts;
  std::vector<Error> errors;
  std::int64_t edges = 0;  ///< of the whole graph; as far as is known where the log has no end
};

/// @throws FileError, ParseError
EventLog read_event_log(const std::string& path);

}  // namespace isotherm::apps
