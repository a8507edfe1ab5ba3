#include "pages.hpp"

#include <filesystem>
#include <utility>

#include "report/build/graph_report.hpp"
#include "report/build/network_report.hpp"
#include "report/report_json.hpp"
#include "report/report_page.hpp"
#include "run.hpp"

namespace isotherm::python {
namespace {

constexpr std::size_t kMostDrawn = 20000;
constexpr const char* kFrame =
    "<iframe sandbox=\"allow-scripts\" width=\"100%\" height=\"700\" style=\"border: 0\" srcdoc=\"";

std::string escaped(const std::string& text) {
  std::string safe;
  safe.reserve(text.size() + text.size() / 8);
  for (const char c : text) {
    if (c == '&') {
      safe += "&amp;";
    } else if (c == '"') {
      safe += "&quot;";
    } else if (c == '<') {
      safe += "&lt;";
    } else {
      safe += c;
    }
  }
  return safe;
}

}  // namespace

std::string title_of(const std::string& path, const std::string& otherwise) {
  return path.empty() ? otherwise : std::filesystem::path(path).filename().string();
}

std::string page_of(const apps::Report& report) { return apps::report_page(apps::to_json(report)); }

std::string page_of(nb::object owner, const Graph& graph,
                    const spectral::JudgeEdgesOptions& options,
                    const spectral::JudgeEdgesResult& result) {
  return without_gil({}, std::move(owner), [&graph, &result, options](const RunContext& context) {
    const apps::EdgesRun run{title_of(graph.report.path, "graph"), options, graph.ids,
                             graph.points};
    const auto left = spectral::apply_verdicts(graph.graph, result.verdicts);
    return page_of(apps::graph_report(graph.graph, left, result, run, context));
  });
}

std::string page_of(nb::object owner, const network::RangeNetwork& network, const std::string& path,
                    const network::LocalizeOptions& options, const network::LocalizeResult& result,
                    nb::handle truth) {
  apps::LocalizeRun run{title_of(path, "network"), options, {}};
  if (!truth.is_none()) {
    run.truth = columns_of(truth, "truth", network.dimension);
    require_length("truth", static_cast<std::size_t>(run.truth.cols()), network.names.size());
  }
  return without_gil({}, std::move(owner), [&network, &result, run](const RunContext&) {
    return page_of(apps::network_report(network, result, run));
  });
}

std::string framed(std::size_t vertices, const std::string& summary,
                   const std::function<std::string()>& page) {
  if (vertices > kMostDrawn) return "<pre>" + escaped(summary) + "</pre>";
  return kFrame + escaped(page()) + "\"></iframe>";
}

}  // namespace isotherm::python
