#include "report/report_flags.hpp"

#include <filesystem>

#include "isotherm/base/text_writer.hpp"
#include "report/report_json.hpp"
#include "report/report_page.hpp"
#include "report/report_svg.hpp"

namespace isotherm::apps {
namespace {

void write_text(const std::string& path, const std::string& text) {
  OutputFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace

void ReportFlags::add_to(CLI::App& verb) {
  verb.add_option("--report", report,
                  "page that explains the run, or, if named .json, the document it shows")
      ->type_name("FILE");
  verb.add_option("--svg", svg, "the map as a plain SVG picture")->type_name("FILE");
}

void write_report_document(const std::string& path, const Json& document) {
  write_text(path, path.ends_with(".json") ? report_text(document) + "\n" : report_page(document));
}

void write_report(const ReportFlags& flags, const Report& report) {
  if (!flags.report.empty()) write_report_document(flags.report, to_json(report));
  if (!flags.svg.empty()) write_text(flags.svg, report_svg(report));
}

std::string file_title(const std::string& path) {
  return path == "-" ? "standard input" : std::filesystem::path(path).filename().string();
}

}  // namespace isotherm::apps
