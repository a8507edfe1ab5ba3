#include <nanobind/nanobind.h>

#include "modules.hpp"

NB_MODULE(_core, core) {
  using namespace isotherm::python;
  core.doc() = "The compiled part of isotherm.";
  core.def(
      "version", [] { return ISOTHERM_VERSION; }, "Of the library.");
  bind_errors();

  auto spectral = core.def_submodule("spectral", "Graphs: spectra, heat, resistances, edges.");
  bind_verdicts(spectral);
  bind_graphs(spectral);
  bind_spectra(spectral);
  bind_edges(spectral);

  auto geometry = core.def_submodule("geometry", "Points and curves.");
  bind_geometry(geometry);

  auto network = core.def_submodule("network", "Sensor networks.");
  bind_networks(network);

  auto slam = core.def_submodule("slam", "Pose graphs.");
  bind_pose_graphs(slam);
  bind_prune(slam);
  bind_optimize(slam);
  bind_simulate(slam);
  bind_evaluate(slam);
}
