#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "isotherm/base/error.hpp"
#include "isotherm/slam/online/online_consensus.hpp"

namespace isotherm::apps {

/// Keeps what has come in a file to which lines are only ever added: whenever a process ends, all
/// that it has said anything of is there.
class StateFile {
 public:
  /// Nothing is kept where `path` is empty.
  explicit StateFile(std::string path) : path_(std::move(path)) {}

  /// Goes on from the file, if there is one. @throws FileError, ParseError
  template <class Pose>
  slam::OnlineConsensus<Pose> open(const slam::OnlineOptions& options, RunContext run) {
    if (path_.empty()) return slam::OnlineConsensus<Pose>(options, std::move(run));
    if (std::filesystem::exists(path_)) drop_unfinished_line();
    const bool known = std::filesystem::exists(path_) && std::filesystem::file_size(path_) > 0;
    std::ifstream in(path_);
    auto online = known ? slam::OnlineConsensus<Pose>::load(in, options, std::move(run))
                        : slam::OnlineConsensus<Pose>(options, std::move(run));
    out_.open(path_, std::ios::app);
    if (!out_) throw FileError(path_, "cannot be written");
    return online;
  }

  /// Entries that it was opened with.
  std::uint64_t entries() const noexcept { return entries_; }

  /// Adds what has come since. @throws FileError
  template <class Pose>
  void append(slam::OnlineConsensus<Pose>& online) {
    if (path_.empty()) return;
    online.journal(out_);
    out_ << std::flush;
    if (!out_) throw FileError(path_, "cannot be written");
  }

 private:
  // A process that ended while it wrote leaves a line without its end.
  void drop_unfinished_line() {
    std::ifstream in(path_);
    const std::string whole(std::istreambuf_iterator<char>(in), {});
    const auto size = whole.rfind('\n') + 1;
    std::filesystem::resize_file(path_, size);
    std::uint64_t lines = 0;
    for (const char c : whole) lines += c == '\n' ? 1 : 0;
    entries_ = lines > 0 ? lines - 1 : 0;
  }

  std::string path_;
  std::uint64_t entries_ = 0;
  std::ofstream out_;
};

}  // namespace isotherm::apps
