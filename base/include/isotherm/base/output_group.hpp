#pragma once

#include <memory>

namespace isotherm {

namespace detail {
class TemporaryFile;
}

/// Output files that appear together or not at all.
///
/// While a group lives, OutputFile::commit() on the same thread only finishes the file; the
/// group's commit gives the names. Without it no file of the group appears, and older ones
/// stay. Standard output and devices are written as they come. Groups do not nest.
class OutputGroup {
 public:
  OutputGroup();
  ~OutputGroup();
  OutputGroup(const OutputGroup&) = delete;
  OutputGroup& operator=(const OutputGroup&) = delete;

  /// @throws FileError if a name cannot be given; the files before it are then in place.
  void commit();

 private:
  friend class OutputFile;
  static bool take(detail::TemporaryFile& file);  // false where there is no group

  struct State;
  std::unique_ptr<State> state_;
};

/// Whether a group of this process is giving its files their names, which takes a moment and
/// should not be cut short, or has. Safe in a signal handler.
bool outputs_in_place() noexcept;

/// Removes what unfinished outputs have in the file system. For a signal handler that is
/// about to end the process, and safe in one.
void abandon_outputs() noexcept;

}  // namespace isotherm
