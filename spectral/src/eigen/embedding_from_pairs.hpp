#pragma once

#include <cstdint>
#include <functional>

#include "isotherm/spectral/eigen/embed.hpp"

namespace isotherm::spectral::detail {

/// Finds the smallest eigenpairs of the Laplacian that EmbedOptions name.
using FindEigenpairs = std::function<EigenDecomposition(EigenOptions)>;

/// embed() of a graph of this size, wherever it is. Where `find` gives only some rows of the
/// vectors, so has the result.
EmbedResult embed(std::int64_t vertex_count, std::int64_t component_count,
                  const EmbedOptions& options, const FindEigenpairs& find);

}  // namespace isotherm::spectral::detail
