#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>

#include "arrays.hpp"
#include "isotherm/spectral/edges/edge_verdicts.hpp"
#include "isotherm/spectral/edges/verdict_file.hpp"

namespace isotherm::python {

/// Decisions as Python has them.
struct Verdicts {
  spectral::EdgeVerdicts rows;
  spectral::VertexNames names = {};  ///< what the ends are called, where they have names
};

/// The numbers of a member of each row, in place.
template <class Row, class T>
View1<T> member_view(const std::vector<Row>& rows, T Row::*member, nb::handle owner) {
  static const Row kNone = {};
  const Row& first = rows.empty() ? kNone : rows.front();
  return strided_view(&(first.*member), rows.size(), sizeof(Row), owner);
}

/// `Verdicts(3, 2 keep, 1 prune, 0 ambiguous)`.
std::string in_words(const spectral::EdgeVerdicts& rows);

/// The columns of a verdict file, by their names.
nb::dict columns(const Verdicts& verdicts, nb::handle owner);

/// The same, as a table of pandas.
nb::object data_frame(Verdicts verdicts);

}  // namespace isotherm::python
