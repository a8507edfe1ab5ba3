#include "verbs/follow/call_times.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "isotherm/base/statistics.hpp"

namespace isotherm::apps {

double CallTimes::total() const { return std::accumulate(wall_.begin(), wall_.end(), 0.0); }

double CallTimes::quantile_of(const std::vector<double>& seconds, double share) {
  if (seconds.empty()) return 0.0;
  return 1e3 * (share < 1.0 ? quantile(seconds, share) : *std::ranges::max_element(seconds));
}

Json CallTimes::summary_of(const std::vector<double>& seconds) {
  return {{"median", quantile_of(seconds, 0.5)},
          {"p99", quantile_of(seconds, 0.99)},
          {"worst", quantile_of(seconds, 1.0)}};
}

Json CallTimes::summary() const {
  return {{"latency_ms", summary_of(wall_)}, {"cpu_ms", summary_of(cpu_)}};
}

void CallTimes::write(const std::string& path) const {
  if (path.empty()) return;
  std::string text = "edge,poses,ms,cpu_ms\n";
  for (std::size_t k = 0; k < wall_.size(); ++k) {
    text += fmt::format("{},{},{:.4f},{:.4f}\n", k, poses_[k], 1e3 * wall_[k], 1e3 * cpu_[k]);
  }
  write_text(path, text);
}

}  // namespace isotherm::apps
