#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "isotherm/spectral/types.hpp"

namespace isotherm::slam::detail {

/// Classes of loops that span about as many vertices: none, and one a power of two.
inline constexpr std::size_t kSpanClasses = 33;

/// That of a loop with `span` vertices between its ends.
inline std::size_t span_class(spectral::Index span) {
  return static_cast<std::size_t>(std::bit_width(static_cast<std::uint32_t>(span)));
}

}  // namespace isotherm::slam::detail
