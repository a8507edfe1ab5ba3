#pragma once

#include <string>
#include <string_view>

#include "isotherm/base/csv.hpp"
#include "isotherm/base/options.hpp"

namespace isotherm {

/// The field in `column` of the current row as one of an enumeration's names.
/// @throws ParseError listing the names, if it is none of them
template <class Enum>
Enum csv_enum(const CsvReader& csv, std::size_t column, std::string_view what) {
  const auto text = csv.text(column, what);
  for (const auto& entry : enum_names(Enum{})) {
    if (entry.name == text) return entry.value;
  }
  csv.fail(column, "expected a " + std::string(what) + ": " + joined_enum_names<Enum>());
}

}  // namespace isotherm
