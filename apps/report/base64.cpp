#include "report/base64.hpp"

#include <algorithm>
#include <cstdint>
#include <string_view>

namespace isotherm::apps {
namespace {

constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

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

}  // namespace isotherm::apps
