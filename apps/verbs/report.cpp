#include <memory>

#include "isotherm/base/error.hpp"
#include "json_file.hpp"
#include "option_verb.hpp"
#include "report/report_check.hpp"
#include "report/report_flags.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

Json read_document(const std::string& path) {
  auto document = read_json(path);
  check_report(document, path);
  return document;
}

struct ReportVerb : OptionVerb<NoOptions> {
  std::string input;
  std::string output;

  int run() {
    if (resolve_or_dump()) return kOk;
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
  report->flags.outputs
      .add(*verb, "-o,--output", report->output, "page to write (- for stdout)", {".html", ".json"})
      ->required();
  report->add_flags(*verb);
  return verb_of(verb, report);
}

}  // namespace isotherm::apps
