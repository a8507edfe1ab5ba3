#pragma once

#include "isotherm/base/read_report.hpp"
#include "isotherm/base/text_reader.hpp"
#include "isotherm/network/io/range_rows.hpp"
#include "isotherm/network/range_network.hpp"

namespace isotherm::network::detail {

/// Reads rows of the given kind; RangeRows::none is read as intervals, whose errors
/// then say what is wrong. Names the format in `report`. Negative times of flight, which
/// radios report when their clocks wrap, are left out as repairs.
/// @throws ParseError
RangeNetwork read_range_rows(TextReader& text, RangeRows kind, const ReadOptions& options,
                             ReadReport& report);

}  // namespace isotherm::network::detail
