#pragma once

#include <string>

#include "isotherm/spectral/edges/edge_verdicts.hpp"

namespace isotherm::spectral {

/// Writes one row a verdict: `edge,from,to,verdict,score,threshold,stage`, below a
/// line with these names. The path "-" is stdout; a file appears whole or not at
/// all. @throws FileError
void write_verdicts(const std::string& path, const EdgeVerdicts& verdicts);

/// Reads what write_verdicts writes; columns are found by name.
/// @throws FileError, ParseError
EdgeVerdicts read_verdicts(const std::string& path);

}  // namespace isotherm::spectral
