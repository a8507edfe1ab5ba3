#pragma once

#include <cstdint>
#include <string>

#include <CLI/CLI.hpp>

namespace isotherm::apps {

/// A flag for any number from 0 to 2^64 - 1. A negative one is refused, which would wrap.
inline CLI::Option* add_unsigned(CLI::App& verb, const std::string& flag, std::uint64_t& value,
                                 const std::string& help) {
  const auto refuse_sign = [](const std::string& text) {
    return text.find('-') == std::string::npos ? "" : "must not be negative (got " + text + ")";
  };
  return verb.add_option(flag, value, help + "; in [0, 2^64)")->check(refuse_sign, "", "");
}

}  // namespace isotherm::apps
