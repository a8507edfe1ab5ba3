#pragma once

#include <string_view>

namespace isotherm::network {

/// Files of ranges that are rows of numbers without tags or column names.
enum class RangeRows {
  none,
  intervals,     ///< `i j lower upper [names]`: distance geometry's nmr files
  beacons,       ///< `time tag beacon range`: radio beacons heard by one moving tag
  flight_times,  ///< `microseconds node node` and 18 columns of radio diagnostics
};

/// Tells which rows `text`, the start of a file, consists of. A trajectory may
/// start like one of them; that all rows do would be a coincidence, so all are
/// looked at (a last line without an end may be cut off and is not).
RangeRows detect_range_rows(std::string_view text);

}  // namespace isotherm::network
