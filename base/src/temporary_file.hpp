#pragma once

#include <string>

namespace isotherm::detail {

/// A file on its way to the place of `target`. Where the file system allows it, it has no
/// name before, so that not even a killed process leaves it behind.
class TemporaryFile {
 public:
  /// `target` as output_target() gives it; `path` is what messages call it. Check
  /// descriptor(): it is -1, and errno says why, where the file cannot be made.
  TemporaryFile(std::string path, std::string target);
  ~TemporaryFile();
  TemporaryFile(TemporaryFile&& other) noexcept;
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  TemporaryFile& operator=(TemporaryFile&&) = delete;

  /// For writing; to be closed by who takes it.
  int descriptor() const noexcept { return descriptor_; }

  /// Replaces the target. @throws FileError
  void take_place();

 private:
  void name(std::string temporary);
  void forget_name();

  std::string path_;
  std::string target_;
  std::string temporary_;  // a name that exists; empty while there is none
  int descriptor_ = -1;
  int unnamed_ = -1;  // second descriptor of a file without a name, or -1
};

}  // namespace isotherm::detail
