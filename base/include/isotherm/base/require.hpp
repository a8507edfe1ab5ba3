#pragma once

#include <cmath>
#include <string>

#include "isotherm/base/error.hpp"

namespace isotherm {

/// @throws InvalidArgument naming `option` unless `value` is finite and positive
inline void require_positive(const std::string& option, double value) {
  if (!(std::isfinite(value) && value > 0.0)) {
    throw InvalidArgument(option, "must be finite and positive");
  }
}

}  // namespace isotherm
