#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace isotherm::apps {

/// The bytes in base64 (RFC 4648, section 4), with padding.
std::string base64(std::span<const std::byte> bytes);

/// The bytes that base64() made `text` of; nothing where it is no such text.
std::optional<std::vector<std::byte>> from_base64(std::string_view text);

}  // namespace isotherm::apps
