#include "temporary_file.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include "isotherm/base/error.hpp"
#include "isotherm/base/output_group.hpp"

namespace isotherm {
namespace {

// Names for abandon_outputs(), which must not allocate; a file that finds no place is only
// not cleaned up after.
std::array<std::atomic<char*>, 64> named_temporaries{};

void remember(const std::string& name) {
  char* const copy = ::strdup(name.c_str());
  if (copy == nullptr) return;
  for (auto& place : named_temporaries) {
    char* empty = nullptr;
    if (place.compare_exchange_strong(empty, copy)) return;
  }
  std::free(copy);
}

void forget(const std::string& name) {
  for (auto& place : named_temporaries) {
    char* held = place.load();
    if (held == nullptr || name != held) continue;
    if (place.compare_exchange_strong(held, nullptr)) std::free(held);
    return;
  }
}

// A name beside `target` that no other writer of any process uses.
std::string temporary_name(const std::string& target) {
  static std::atomic<unsigned> counter{0};
  return target + ".part-" + std::to_string(::getpid()) + "-" + std::to_string(counter++);
}

// What links a file without a name to one.
std::string name_of_descriptor(int descriptor) {
  return "/proc/self/fd/" + std::to_string(descriptor);
}

// A file that has no name yet; -1 where the file system has none.
int open_unnamed(const std::string& target) {
#ifdef O_TMPFILE
  const std::string folder = std::filesystem::path(target).parent_path().string();
  const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
  if (descriptor >= 0 && ::access(name_of_descriptor(descriptor).c_str(), F_OK) == 0) {
    return descriptor;
  }
  if (descriptor >= 0) ::close(descriptor);
#endif
  return -1;
}

}  // namespace

void abandon_outputs() noexcept {
  for (auto& place : named_temporaries) {
    if (const char* name = place.load(); name != nullptr) ::unlink(name);
  }
}

namespace detail {

TemporaryFile::TemporaryFile(std::string path, std::string target)
    : path_(std::move(path)), target_(std::move(target)), descriptor_(open_unnamed(target_)) {
  if (descriptor_ >= 0) {
    unnamed_ = ::dup(descriptor_);
    return;
  }
  name(temporary_name(target_));
  descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor_ < 0) forget_name();
}

TemporaryFile::TemporaryFile(TemporaryFile&& other) noexcept
    : path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)),
      unnamed_(std::exchange(other.unnamed_, -1)) {}

TemporaryFile::~TemporaryFile() {
  if (unnamed_ >= 0) ::close(unnamed_);
  if (temporary_.empty()) return;
  ::unlink(temporary_.c_str());
  forget_name();
}

void TemporaryFile::name(std::string temporary) {
  temporary_ = std::move(temporary);
  remember(temporary_);
}

void TemporaryFile::forget_name() {
  const int kept = errno;
  forget(temporary_);
  temporary_.clear();
  errno = kept;
}

void TemporaryFile::take_place() {
  const auto fail = [this] {
    throw FileError(path_, std::string("cannot be written: ") + std::strerror(errno));
  };
  if (unnamed_ >= 0) {
    name(temporary_name(target_));
    const int linked = ::linkat(AT_FDCWD, name_of_descriptor(unnamed_).c_str(), AT_FDCWD,
                                temporary_.c_str(), AT_SYMLINK_FOLLOW);
    if (linked != 0) fail();
  }
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail();
  forget_name();
}

}  // namespace detail
}  // namespace isotherm
