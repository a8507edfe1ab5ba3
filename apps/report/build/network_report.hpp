#pragma once

#include <string>

#include <Eigen/Core>

#include "isotherm/network/localize/localize.hpp"
#include "report/report.hpp"

namespace isotherm::apps {

/// What a run of `localize` was given besides the network.
struct LocalizeRun {
  std::string title;  ///< name of the input file
  network::LocalizeOptions options;
  Eigen::MatrixXd truth;  ///< dimension x nodes, NaN where not known; or empty
};

/// Explains where the nodes of a network are and which ranges were judged false. Without
/// anchors the truth is moved onto the result by the isometry that fits best.
/// @throws NumericalError, Cancelled
Report network_report(const network::RangeNetwork& network, const network::LocalizeResult& result,
                      const LocalizeRun& run);

}  // namespace isotherm::apps
