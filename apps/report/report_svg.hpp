#pragma once

#include <string>

#include "report/report.hpp"

namespace isotherm::apps {

/// The last layout of the report as an SVG picture for papers: trusted edges, kept,
/// pruned and ambiguous candidates, truth where it is known, a legend and a scale bar.
/// Space is drawn from a fixed direction. Plain SVG 1.1 without script or style sheet.
std::string report_svg(const Report& report);

}  // namespace isotherm::apps
