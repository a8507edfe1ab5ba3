#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "isotherm/base/error.hpp"

/// How options describe themselves.
///
/// An options aggregate `O` may offer `visit_fields(O&, visitor)`, found by
/// argument-dependent lookup, which calls `visitor(name, reference, help)` once
/// a field, with the field's Range (range.hpp) as a fourth argument where that is a
/// number or a list of them. Command-line flags, help, configuration files and
/// validation are all made from that one list. An enumeration used as a field
/// offers `enum_names(E)`, a table of its values and their names.
namespace isotherm {

template <class Enum>
struct EnumName {
  Enum value;
  std::string_view name;
};

/// The table entry's name for `value`.
/// @throws InvalidArgument if the value is not in the table.
template <class Enum>
std::string_view enum_name(Enum value) {
  for (const auto& entry : enum_names(value)) {
    if (entry.value == value) return entry.name;
  }
  throw InvalidArgument("enumeration", "value without a name");
}

/// All names of an enumeration, separated by `separator`.
template <class Enum>
std::string joined_enum_names(std::string_view separator = "|") {
  std::string joined;
  for (const auto& entry : enum_names(Enum{})) {
    if (!joined.empty()) joined += separator;
    joined += entry.name;
  }
  return joined;
}

/// The value called `name`.
/// @throws InvalidArgument naming `option` and listing the known names.
template <class Enum>
Enum enum_value(std::string_view option, std::string_view name) {
  for (const auto& entry : enum_names(Enum{})) {
    if (entry.name == name) return entry.value;
  }
  throw InvalidArgument(std::string(option), "unknown value '" + std::string(name) +
                                                 "', expected one of " + joined_enum_names<Enum>());
}

}  // namespace isotherm
