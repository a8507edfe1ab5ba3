#include <fstream>
#include <iostream>
#include <memory>

#include "isotherm/base/error.hpp"
#include "report/report_flags.hpp"
#include "report/report_json.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

Json parse(const std::string& path, std::istream& stream) {
  try {
    return Json::parse(stream);
  } catch (const nlohmann::json::parse_error& error) {
    throw ParseError({path, 0, 0}, "", std::string("is not valid JSON: ") + error.what());
  }
}

Json read_document(const std::string& path) {
  Json document;
  if (path == "-") {
    document = parse(path, std::cin);
  } else {
    std::ifstream file(path);
    if (!file) throw FileError(path, "cannot be opened");
    document = parse(path, file);
  }
  if (!document.is_object() || document.value("schema", Json()) != kReportSchema) {
    throw ParseError({path, 0, 0}, "",
                     std::string("is not an ") + kReportSchema +
                         " document; 'prune --report FILE.json' writes one");
  }
  return document;
}

struct ReportVerb {
  CommonFlags flags;
  std::string input;
  std::string output;

  int run() const {
    write_report_document(output, read_document(input));
    return kOk;
  }
};

}  // namespace

Verb add_report(CLI::App& root) {
  auto report = std::make_shared<ReportVerb>();
  CLI::App* verb = root.add_subcommand("report", "write the page that explains a saved run");
  verb->add_option("input", report->input, "document that --report FILE.json saved (- for stdin)")
      ->required();
  verb->add_option("-o,--output", report->output, "page to write (- for stdout)")
      ->required()
      ->type_name("FILE");
  add_common_flags(*verb, report->flags);
  return {verb, [report] { return report->run(); }};
}

}  // namespace isotherm::apps
