#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "isotherm/base/text_reader.hpp"

namespace isotherm::spectral::distributed::detail {

/// A file of which any part can be read by itself.
class ByteFile {
 public:
  /// @throws FileError unless it can be read so
  explicit ByteFile(const std::string& path);
  ~ByteFile();
  ByteFile(const ByteFile&) = delete;
  ByteFile& operator=(const ByteFile&) = delete;

  const std::string& path() const noexcept { return path_; }
  std::uint64_t size() const noexcept { return size_; }

  /// Fills the span, or as much of it as the file has behind `offset`.
  /// @throws FileError
  std::size_t read(std::uint64_t offset, std::span<char> target) const;

  /// The first bytes. @throws FileError
  std::string start(std::size_t size) const;

  /// Where the first line begins that begins at `offset` or behind it. @throws FileError
  std::uint64_t line_start(std::uint64_t offset) const;

  /// Ends of lines between two offsets. @throws FileError
  std::uint64_t count_lines(std::uint64_t begin, std::uint64_t end) const;

  /// `first`, then the bytes from `begin` to `end`. This must outlive it.
  TextReader::Source part(std::string first, std::uint64_t begin, std::uint64_t end) const;

 private:
  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace isotherm::spectral::distributed::detail
