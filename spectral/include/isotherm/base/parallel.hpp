#pragma once

#include <cstdint>
#include <functional>
#include <string_view>

#include "isotherm/base/progress.hpp"

namespace isotherm {

/// Runs body(index) for every index in [0, count) on `threads` threads (0: all
/// cores), in any order; calls for different indices must not depend on each other.
/// Progress is reported under the name `stage`, from the calling thread only.
/// @throws InvalidArgument if threads < 0, Cancelled, and what the body throws.
void parallel_for(std::int64_t count, int threads, const ProgressCallback& progress,
                  std::string_view stage, const std::function<void(std::int64_t)>& body);

}  // namespace isotherm
