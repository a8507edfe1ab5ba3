#include "report/base64.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace isotherm::apps {
namespace {

constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

// What each character stands for, 64 for those that are no digit.
std::array<std::uint8_t, 256> digit_values() {
  std::array<std::uint8_t, 256> values;
  values.fill(64);
  for (std::size_t k = 0; k < kDigits.size(); ++k) {
    values[static_cast<unsigned char>(kDigits[k])] = static_cast<std::uint8_t>(k);
  }
  return values;
}

}  // namespace

std::string base64(std::span<const std::byte> bytes) {
  std::string text((bytes.size() + 2) / 3 * 4, '=');
  std::size_t out = 0;
  for (std::size_t in = 0; in < bytes.size(); in += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - in);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (k < count ? std::to_integer<std::uint32_t>(bytes[in + k]) : 0);
    }
    for (std::size_t k = 0; k <= count; ++k) {
      text[out + k] = kDigits[group >> (18 - 6 * k) & 63];
    }
    out += 4;
  }
  return text;
}

std::optional<std::vector<std::byte>> from_base64(std::string_view text) {
  static const auto kValues = digit_values();
  if (text.size() % 4 != 0) return std::nullopt;
  const std::size_t padding = text.ends_with("==") ? 2 : text.ends_with('=') ? 1 : 0;
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3);
  for (std::size_t in = 0; in < text.size(); in += 4) {
    const std::size_t digits = in + 4 == text.size() ? 4 - padding : 4;
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint8_t value = k < digits ? kValues[static_cast<unsigned char>(text[in + k])] : 0;
      if (value == 64) return std::nullopt;
      group = group << 6 | value;
    }
    for (std::size_t k = 0; k + 1 < digits; ++k) {
      bytes.push_back(static_cast<std::byte>(group >> (16 - 8 * k) & 255));
    }
  }
  return bytes;
}

}  // namespace isotherm::apps
