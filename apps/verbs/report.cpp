#include <memory>
#include <string>
#include <vector>

#include "isotherm/base/error.hpp"
#include "json_file.hpp"
#include "option_verb.hpp"
#include "report/report_check.hpp"
#include "report/report_flags.hpp"
#include "report/report_json.hpp"
#include "report/report_page.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

Json read_document(const std::string& path) {
  auto document = read_json(path);
  check_report(document, path);
  return document;
}

// Two runs on one graph, to be shown side by side.
Json compared(const std::vector<std::string>& paths) {
  auto first = read_document(paths[0]);
  auto second = read_document(paths[1]);
  check_same_graph(first, second, paths[1]);
  return {{"schema", kComparisonSchema},
          {"names", {file_title(paths[0]), file_title(paths[1])}},
          {"reports", {std::move(first), std::move(second)}}};
}

struct ReportVerb : OptionVerb<NoOptions> {
  std::vector<std::string> inputs;
  std::string output;

  int run() {
    if (resolve_or_dump()) return kOk;
    const bool one = inputs.size() == 1;
    if (!one && format_suffix(output) == ".json") {
      throw InvalidArgument("output", "two reports are compared on a page: name it .html");
    }
    const Json document = one ? read_document(inputs[0]) : compared(inputs);
    write_report_document(output, document);
    if (!flags.json.empty()) write_text(flags.json, report_text(document) + "\n");
    return kOk;
  }
};

}  // namespace

Verb add_report(CLI::App& root) {
  constexpr int kMost = 2;
  auto report = std::make_shared<ReportVerb>();
  CLI::App* verb = root.add_subcommand(
      "report", "write the page that explains a saved run, or compares two on one graph");
  verb->add_option("input", report->inputs,
                   "document that --report FILE.json saved (- for stdin), or two of one graph")
      ->required()
      ->expected(1, kMost)
      ->type_name("FILE");
  report->flags.outputs
      .add(*verb, "-o,--output", report->output, "page to write (- for stdout)", {".html", ".json"})
      ->required();
  report->add_flags(*verb);
  return verb_of(verb, report);
}

}  // namespace isotherm::apps
