#pragma once

#include <vector>

#include "isotherm/slam/evaluate/labels.hpp"

namespace isotherm::python {

/// What ground truth says about candidates, as Python has it.
struct Labels {
  std::vector<slam::EdgeLabel> rows;
};

}  // namespace isotherm::python
