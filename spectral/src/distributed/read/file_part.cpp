#include "distributed/read/file_part.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "isotherm/base/error.hpp"

namespace isotherm::spectral::distributed::detail {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 20;

}  // namespace

ByteFile::ByteFile(const std::string& path)
    : path_(path), descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
  if (descriptor_ < 0) {
    throw FileError(path, std::string("cannot be opened: ") + std::strerror(errno));
  }
  struct stat status = {};
  if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    throw FileError(path, "is no file that ranks can read their parts of");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

ByteFile::~ByteFile() { ::close(descriptor_); }

std::size_t ByteFile::read(std::uint64_t offset, std::span<char> target) const {
  std::size_t count = 0;
  while (count < target.size()) {
    const auto some = ::pread(descriptor_, target.data() + count, target.size() - count,
                              static_cast<off_t>(offset + count));
    if (some < 0 && errno == EINTR) continue;
    if (some < 0) throw FileError(path_, std::string("cannot be read: ") + std::strerror(errno));
    if (some == 0) break;
    count += static_cast<std::size_t>(some);
  }
  return count;
}

std::string ByteFile::start(std::size_t size) const {
  std::string text(size, '\0');
  text.resize(read(0, text));
  return text;
}

std::uint64_t ByteFile::line_start(std::uint64_t offset) const {
  if (offset == 0) return 0;
  std::vector<char> chunk(1 << 16);
  for (std::uint64_t at = offset - 1; at < size_;) {
    const std::size_t count = read(at, chunk);
    if (count == 0) break;
    const auto found = std::find(chunk.begin(), chunk.begin() + count, '\n') - chunk.begin();
    if (static_cast<std::size_t>(found) < count) return at + static_cast<std::uint64_t>(found) + 1;
    at += count;
  }
  return size_;
}

std::uint64_t ByteFile::count_lines(std::uint64_t begin, std::uint64_t end) const {
  std::vector<char> chunk(kChunk);
  std::uint64_t lines = 0;
  while (begin < end) {
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(kChunk, end - begin));
    const std::size_t count = read(begin, std::span(chunk).first(wanted));
    if (count == 0) break;
    lines += static_cast<std::uint64_t>(std::count(chunk.begin(), chunk.begin() + count, '\n'));
    begin += count;
  }
  return lines;
}

TextReader::Source ByteFile::part(std::string first, std::uint64_t begin, std::uint64_t end) const {
  return [this, first = std::move(first), begin, end](std::span<char> target) mutable {
    if (!first.empty()) {
      const std::size_t count = std::min(first.size(), target.size());
      std::copy_n(first.begin(), count, target.begin());
      first.erase(0, count);
      return count;
    }
    const auto wanted =
        static_cast<std::size_t>(std::min<std::uint64_t>(target.size(), end - begin));
    const std::size_t count = read(begin, target.first(wanted));
    if (count < wanted) throw FileError(path_, "became shorter while it was read");
    begin += count;
    return count;
  };
}

}  // namespace isotherm::spectral::distributed::detail
