#include "report/report_flags.hpp"

#include <filesystem>

#include "isotherm/base/error.hpp"
#include "report/report_json.hpp"
#include "report/report_page.hpp"
#include "report/report_svg.hpp"

namespace isotherm::apps {
void ReportFlags::add_to(CLI::App& verb, OutputFlags& outputs) {
  outputs.add(verb, "--report", report,
              "page that explains the run, or, if named .json, the document it shows",
              {".html", ".json"});
  outputs.add(verb, "--svg", svg, "the map as a plain SVG picture", {".svg"});
}

void ReportFlags::require_wanted(const std::string& flag) const {
  if (!wanted()) throw InvalidArgument(flag, "is for the report: it needs --report or --svg");
}

void write_report_document(const std::string& path, const Json& document) {
  write_text(path,
             format_suffix(path) == ".json" ? report_text(document) + "\n" : report_page(document));
}

void write_report(const ReportFlags& flags, const Report& report) {
  if (!flags.report.empty()) write_report_document(flags.report, to_json(report));
  if (!flags.svg.empty()) write_text(flags.svg, report_svg(report));
}

std::string file_title(const std::string& path) {
  return path == "-" ? "standard input" : std::filesystem::path(path).filename().string();
}

std::string files_title(const std::vector<std::string>& paths) {
  std::string title;
  for (const auto& path : paths) title += (title.empty() ? "" : ", ") + file_title(path);
  return title;
}

}  // namespace isotherm::apps
