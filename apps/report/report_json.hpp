#pragma once

#include "report/report.hpp"

namespace isotherm::apps {

inline constexpr const char* kReportSchema = "isotherm.report/1";
inline constexpr const char* kComparisonSchema = "isotherm.comparison/1";

/// The document, schema isotherm.report/1. Arrays are objects with one member that
/// names the element type (f32, i32, u32, u8 or u64) and holds the little-endian
/// values in base64.
Json to_json(const Report& report);

}  // namespace isotherm::apps
