#pragma once

#include <chrono>
#include <cstdint>
#include <ctime>
#include <string>
#include <vector>

#include "command.hpp"

namespace isotherm::apps {

/// How long calls took, on the clock and in work of the processor, which other programs on the
/// machine change little.
class CallTimes {
 public:
  /// Calls `work` and notes what it took; `poses` had come before.
  template <class Work>
  auto of(std::uint64_t poses, Work&& work) {
    const auto wall = std::chrono::steady_clock::now();
    const std::clock_t cpu = std::clock();
    auto result = work();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - wall;
    poses_.push_back(poses);
    wall_.push_back(took.count());
    cpu_.push_back(static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC);
    return result;
  }

  /// In milliseconds; 0 without calls.
  double wall_quantile(double share) const { return quantile_of(wall_, share); }

  /// Seconds of all calls.
  double total() const;

  /// Of both, median, 99 % and the worst in milliseconds.
  Json summary() const;

  /// A row a call: edge,poses,ms,cpu_ms. @throws FileError
  void write(const std::string& path) const;

 private:
  static double quantile_of(const std::vector<double>& seconds, double share);
  static Json summary_of(const std::vector<double>& seconds);

  std::vector<std::uint64_t> poses_;
  std::vector<double> wall_;
  std::vector<double> cpu_;
};

}  // namespace isotherm::apps
