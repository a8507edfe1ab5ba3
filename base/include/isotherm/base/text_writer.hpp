#pragma once

#include <concepts>
#include <memory>
#include <string>
#include <string_view>

namespace isotherm {

/// Appends the shortest decimal text that reads back to exactly `value`.
void append_number(std::string& text, double value);

/// Appends an integer.
template <std::integral Integer>
void append_number(std::string& text, Integer value) {
  text += std::to_string(value);
}

/// The shortest decimal text that reads back to exactly `value`.
std::string format_number(double value);

/// An output file that appears whole or not at all.
///
/// What is written goes to a temporary in the target's folder, which takes the
/// target's name in `commit`; without it the temporary is removed and an older
/// file of that name stays. Where the file system allows it, the temporary has no
/// name before, so that not even a killed process leaves it behind. A symbolic link
/// is followed. The path "-" is standard output, and a path that is
/// no regular file (a device, a pipe) is written directly. A name that ends in
/// ".gz" is compressed.
class OutputFile {
 public:
  /// @throws FileError if the file cannot be created.
  explicit OutputFile(std::string path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// @throws FileError if the disk is full, say.
  void write(std::string_view text);

  /// Writes what is pending and gives the file its name, or leaves that to the OutputGroup
  /// that lives on this thread.
  /// @throws FileError if that fails; the target is then untouched.
  void commit();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace isotherm
