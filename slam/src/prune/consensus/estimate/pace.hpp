#pragma once

#include <functional>

namespace isotherm::slam::detail {

/// Told after each piece of a long computation how much work it was, in links of the graph that
/// were linearised, so that who waits for it can have it pause there. May throw to end it.
using Pace = std::function<void(double work)>;

}  // namespace isotherm::slam::detail
