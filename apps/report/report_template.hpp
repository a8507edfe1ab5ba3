#pragma once

#include <string_view>

namespace isotherm::apps {

/// The page without data: viewer/dist/report.html, built into the program.
std::string_view report_template();

}  // namespace isotherm::apps
