#include "verbs/pose_graph_input.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "console.hpp"

namespace isotherm::apps {
namespace {

// One line a kind of finding: a file may have thousands of the same.
void warn_of(const ReadReport& report, const std::map<std::string, std::uint64_t>& counts,
             const CommonFlags& flags) {
  for (const auto& [kind, times] : counts) {
    const auto first =
        std::find_if(report.diagnostics.begin(), report.diagnostics.end(),
                     [&kind](const Diagnostic& found) { return found.kind == kind; });
    if (first == report.diagnostics.end()) continue;
    const std::string more =
        times > 1 ? fmt::format(", and {} more like it ('isotherm info' lists them)", times - 1)
                  : "";
    warn(flags, to_string(*first) + more);
  }
}

}  // namespace

slam::PoseGraphFile read_input_graph(const std::string& path, const CommonFlags& flags) {
  auto file = slam::read_pose_graph(path, {.strict = flags.strict});
  warn_of(file.report, file.report.repairs, flags);
  warn_of(file.report, file.report.notes, flags);
  return file;
}

}  // namespace isotherm::apps
