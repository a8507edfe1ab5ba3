#include <memory>
#include <string>
#include <vector>

#include "isotherm/slam/io/file_format.hpp"
#include "option_verb.hpp"
#include "verbs/describe.hpp"
#include "verbs/input/pose_graph_input.hpp"
#include "verbs/verbs.hpp"

namespace isotherm::apps {
namespace {

using slam::FileContent;

struct InfoVerb : OptionVerb<NoOptions> {
  std::vector<std::string> input;

  int run() {
    if (resolve_or_dump()) return kOk;
    const Json description = read_and_describe();
    if (flags.json != "-") write_text("-", to_text(description));
    write_json(flags.json, description);
    return kOk;
  }

 private:
  Json read_and_describe() const {
    if (input.size() > 1) {
      return describe(slam::read_pose_graphs(input, {.strict = flags.strict}));
    }
    TextReader reader(input.front());
    const auto format = slam::require_format(reader);
    const ReadOptions reading{.strict = flags.strict};
    switch (slam::content_of(format)) {
      case FileContent::trajectory:
        return describe(slam::read_trajectory(reader, format, reading));
      case FileContent::graph:
        return describe(spectral::read_graph(reader, reading));
      case FileContent::ranges:
        return describe_ranges(reader, format, reading);
      case FileContent::pose_graph:
      case FileContent::unknown:
        break;
    }
    return describe(slam::read_pose_graph(reader, format, reading));
  }

  // A PyFG file may hold a pose graph beside the ranges; it takes a second pass,
  // which standard input does not allow.
  Json describe_ranges(TextReader& reader, slam::FileFormat format,
                       const ReadOptions& reading) const {
    Json json = describe(network::read_ranges(reader, reading));
    if (format == slam::FileFormat::pyfg && input.front() != "-") {
      Json graph = describe(slam::read_pose_graph(input.front(), reading));
      graph.erase("schema");
      json["pose_graph"] = std::move(graph);
    }
    return json;
  }
};

}  // namespace

Verb add_info(CLI::App& root) {
  auto info = std::make_shared<InfoVerb>();
  CLI::App* verb = root.add_subcommand("info", "say what is in a file");
  add_graph_inputs(*verb, info->input,
                   "pose graph (also several files of one), trajectory, ranges or plain graph "
                   "(- for stdin)");
  info->add_flags(*verb);
  return verb_of(verb, info);
}

}  // namespace isotherm::apps
