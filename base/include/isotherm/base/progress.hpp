#pragma once

#include <cstdint>
#include <functional>
#include <string_view>

namespace isotherm {

/// One step of a long computation, as handed to a ProgressCallback.
struct Progress {
  std::string_view stage;   ///< what is being done, e.g. "heat distances"
  std::uint64_t done = 0;   ///< units finished
  std::uint64_t total = 0;  ///< units in all; 0 when not known
};

/// Called from the thread that started the computation, never concurrently.
/// Returning false asks the computation to stop; it then throws Cancelled.
using ProgressCallback = std::function<bool(const Progress&)>;

}  // namespace isotherm
