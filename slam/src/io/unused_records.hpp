#pragma once

#include <string_view>

namespace isotherm::slam::detail {

/// What a record of other programs is that this library does not use, such as "a landmark";
/// empty for a tag that is not known.
std::string_view unused_record(std::string_view tag);

}  // namespace isotherm::slam::detail
