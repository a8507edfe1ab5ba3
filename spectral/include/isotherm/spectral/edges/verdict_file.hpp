#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "isotherm/spectral/edges/edge_verdicts.hpp"

namespace isotherm::spectral {

/// What people call a vertex, by its number in verdicts.
using VertexNames = std::function<std::string(std::uint64_t)>;

/// Writes one row a verdict: `edge,from,to,verdict,score,threshold,stage`, below a
/// line with these names; `probability` where any is stated, empty for edges without one; and
/// `from_name,to_name` where there are names. The path "-" is stdout; a file appears whole or
/// not at all. @throws FileError
void write_verdicts(const std::string& path, const EdgeVerdicts& verdicts,
                    const VertexNames& names = {});

/// Reads what write_verdicts writes; columns are found by name.
/// @throws FileError, ParseError
EdgeVerdicts read_verdicts(const std::string& path);

}  // namespace isotherm::spectral
