#pragma once

#include <string>

#include <Eigen/Core>

#include "report/report.hpp"

namespace isotherm::apps {

/// A layout with the given coordinates, one row a node; NaN where not known. Its origin
/// is the first row that is known.
ReportLayout report_layout(const std::string& key, const std::string& label,
                           const Eigen::MatrixXd& rows);

}  // namespace isotherm::apps
