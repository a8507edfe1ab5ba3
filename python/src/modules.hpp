#pragma once

#include <nanobind/nanobind.h>

namespace isotherm::python {

namespace nb = nanobind;

// What each source adds to the module of its layer. Classes come before what gives them back.
void bind_errors();
void bind_verdicts(nb::module_& module);
void bind_graphs(nb::module_& spectral);
void bind_spectra(nb::module_& spectral);
void bind_edges(nb::module_& spectral);
void bind_geometry(nb::module_& geometry);
void bind_networks(nb::module_& network);
void bind_pose_graphs(nb::module_& slam);
void bind_prune(nb::module_& slam);
void bind_optimize(nb::module_& slam);
void bind_simulate(nb::module_& slam);
void bind_evaluate(nb::module_& slam);

}  // namespace isotherm::python
