#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "isotherm/base/read_report.hpp"
#include "isotherm/base/text_reader.hpp"

/// Runs `read` on the input. Malformed text must end in an Error, nothing else.
template <class Read>
int read_untrusted(const std::uint8_t* data, std::size_t size, const Read& read) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const bool strict : {false, true}) {
    try {
      isotherm::TextReader reader("input", text);
      read(reader, isotherm::ReadOptions{.strict = strict});
    } catch (const isotherm::Error&) {
    }
  }
  return 0;
}
