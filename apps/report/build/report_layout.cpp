#include "report/build/report_layout.hpp"

namespace isotherm::apps {

ReportLayout report_layout(const std::string& key, const std::string& label,
                           const Eigen::MatrixXd& rows) {
  ReportLayout layout{key, label, {}, std::vector<double>(rows.cols(), 0.0), {}, {}};
  for (Eigen::Index r = 0; r < rows.rows(); ++r) {
    if (!rows.row(r).allFinite()) continue;
    for (Eigen::Index d = 0; d < rows.cols(); ++d) layout.origin[d] = rows(r, d);
    break;
  }
  layout.positions.reserve(rows.size());
  for (Eigen::Index r = 0; r < rows.rows(); ++r) {
    for (Eigen::Index d = 0; d < rows.cols(); ++d) {
      layout.positions.push_back(static_cast<float>(rows(r, d) - layout.origin[d]));
    }
  }
  return layout;
}

}  // namespace isotherm::apps
