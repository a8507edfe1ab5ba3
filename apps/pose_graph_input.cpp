#include "pose_graph_input.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "console.hpp"

namespace isotherm::apps {
namespace {

// The rest is counted; `isotherm info` shows all.
constexpr std::size_t kMostShown = 5;

}  // namespace

slam::PoseGraphFile read_input_graph(const std::string& path, const CommonFlags& flags) {
  auto file = slam::read_pose_graph(path, {.strict = flags.strict});
  const auto& found = file.report.diagnostics;
  for (std::size_t k = 0; k < std::min(found.size(), kMostShown); ++k) {
    warn(flags, to_string(found[k]));
  }
  if (found.size() > kMostShown) {
    warn(flags,
         fmt::format("... and {} more; 'isotherm info' lists them", found.size() - kMostShown));
  }
  return file;
}

}  // namespace isotherm::apps
