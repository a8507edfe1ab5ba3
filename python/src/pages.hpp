#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include <nanobind/nanobind.h>

#include "graph.hpp"
#include "isotherm/network/localize/localize.hpp"
#include "isotherm/spectral/edges/judge_edges.hpp"
#include "report/report.hpp"

/// The page that explains a result, as the command's --report writes it.
namespace isotherm::python {

/// The name of the file at `path`, or what stands for it where there is none.
std::string title_of(const std::string& path, const std::string& otherwise);

std::string page_of(const apps::Report& report);

/// Vertices of the result are positions. `owner` has graph and result.
std::string page_of(nb::object owner, const Graph& graph,
                    const spectral::JudgeEdgesOptions& options,
                    const spectral::JudgeEdgesResult& result);

/// `truth` holds a position a node (NaN: not known), or is None. `owner` has network and result.
std::string page_of(nb::object owner, const network::RangeNetwork& network, const std::string& path,
                    const network::LocalizeOptions& options, const network::LocalizeResult& result,
                    nb::handle truth);

/// What a notebook shows: the page in a frame, or only `summary` where there are more vertices
/// than can be drawn while one waits.
std::string framed(std::size_t vertices, const std::string& summary,
                   const std::function<std::string()>& page);

}  // namespace isotherm::python
