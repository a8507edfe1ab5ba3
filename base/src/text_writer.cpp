#include "isotherm/base/text_writer.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include "isotherm/base/error.hpp"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFlushSize = std::size_t{1} << 18;

// A name beside `target` that no other writer of any process uses.
std::string temporary_name(const std::string& target) {
  static std::atomic<unsigned> counter{0};
  return target + ".part-" + std::to_string(::getpid()) + "-" + std::to_string(counter++);
}

// The file a symbolic link points to, there or not, so that renaming does not replace the
// link.
std::string resolve_links(const std::string& path) {
  constexpr int kLongestChain = 40;  // as the kernel has it
  fs::path target = path;
  std::error_code problem;
  for (int links = 0; links < kLongestChain; ++links) {
    if (!fs::is_symlink(fs::symlink_status(target, problem))) break;
    const auto next = fs::read_symlink(target, problem);
    if (problem) break;
    target = target.parent_path() / next;  // `next` alone where that is absolute
  }
  return target.string();
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

// What links a file without a name to one.
std::string name_of_descriptor(int descriptor) {
  return "/proc/self/fd/" + std::to_string(descriptor);
}

// A file that has no name yet and is gone with the process that writes it; -1 where the
// file system has none.
int open_unnamed(const std::string& target) {
#ifdef O_TMPFILE
  const int descriptor = ::open(folder_of(target).c_str(), O_TMPFILE | O_WRONLY, 0666);
  if (descriptor >= 0 && ::access(name_of_descriptor(descriptor).c_str(), F_OK) == 0) {
    return descriptor;
  }
  if (descriptor >= 0) ::close(descriptor);
#endif
  return -1;
}

std::string system_problem() { return std::strerror(errno); }

}  // namespace

void append_number(std::string& text, double value) {
  std::array<char, 32> digits;
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text.append(digits.data(), result.ptr);
}

std::string format_number(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

struct OutputFile::State {
  std::string path;       // as the caller gave it, for messages
  std::string target;     // what gets the result; empty if it is written directly
  std::string temporary;  // a name that exists until commit; empty while there is none
  int unnamed = -1;       // second descriptor of a file without a name, or -1
  std::string pending;
  gzFile file = nullptr;

  [[noreturn]] void fail(const std::string& problem) const {
    throw FileError(path == "-" ? "<stdout>" : path, "cannot be written: " + problem);
  }

  int open_descriptor() {
    if (path == "-") return ::dup(STDOUT_FILENO);
    std::error_code ignored;
    const auto status = fs::status(path, ignored);
    if (fs::exists(status) && !fs::is_regular_file(status)) return ::open(path.c_str(), O_WRONLY);
    target = resolve_links(path);
    const int descriptor = open_temporary();
    if (descriptor >= 0 && fs::exists(status)) {
      ::fchmod(descriptor, static_cast<mode_t>(status.permissions() & fs::perms::mask));
    }
    return descriptor;
  }

  int open_temporary() {
    const int descriptor = open_unnamed(target);
    if (descriptor >= 0) {
      unnamed = ::dup(descriptor);
      return descriptor;
    }
    temporary = temporary_name(target);
    const int named = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0666);
    if (named < 0) temporary.clear();
    return named;
  }

  void flush() {
    if (pending.empty()) return;
    if (gzwrite(file, pending.data(), static_cast<unsigned>(pending.size())) <= 0) {
      fail(system_problem());
    }
    pending.clear();
  }

  void close() {
    const int code = gzclose(std::exchange(file, nullptr));
    if (code != Z_OK) fail(system_problem());
  }

  // Puts what was written in the place of the target.
  void take_place() {
    if (unnamed >= 0) {
      const std::string name = temporary_name(target);
      if (::linkat(AT_FDCWD, name_of_descriptor(unnamed).c_str(), AT_FDCWD, name.c_str(),
                   AT_SYMLINK_FOLLOW) != 0) {
        fail(system_problem());
      }
      temporary = name;
    }
    if (std::rename(temporary.c_str(), target.c_str()) != 0) fail(system_problem());
    temporary.clear();
  }

  ~State() {
    if (file != nullptr) gzclose(file);
    if (unnamed >= 0) ::close(unnamed);
    if (!temporary.empty()) ::unlink(temporary.c_str());
  }
};

OutputFile::OutputFile(std::string path) : state_(std::make_unique<State>()) {
  state_->path = std::move(path);
  if (state_->path.empty()) state_->fail("empty name");
  const int descriptor = state_->open_descriptor();
  if (descriptor < 0) state_->fail(system_problem());
  // "T" passes the bytes through unchanged.
  state_->file = gzdopen(descriptor, state_->path.ends_with(".gz") ? "wb" : "wbT");
  if (state_->file == nullptr) {
    ::close(descriptor);
    state_->fail("out of memory");
  }
}

OutputFile::~OutputFile() = default;

void OutputFile::write(std::string_view text) {
  state_->pending += text;
  if (state_->pending.size() >= kFlushSize) state_->flush();
}

void OutputFile::commit() {
  state_->flush();
  state_->close();
  if (!state_->target.empty()) state_->take_place();
}

std::string output_target(const std::string& path) {
  if (path == "-") return path;
  std::error_code problem;
  const auto target = fs::weakly_canonical(resolve_links(path), problem);
  return problem ? path : target.string();
}

void require_writable(const std::string& path) {
  const auto fail = [&path](const std::string& problem) {
    throw FileError(path, "cannot be written: " + problem);
  };
  if (path.empty()) fail("empty name");
  if (path == "-") return;
  std::error_code ignored;
  const auto status = fs::status(path, ignored);
  if (fs::is_directory(status)) fail(std::strerror(EISDIR));
  const bool in_place = fs::exists(status) && !fs::is_regular_file(status);
  const std::string needed = in_place ? path : folder_of(resolve_links(path)).string();
  if (::access(needed.c_str(), in_place ? W_OK : W_OK | X_OK) != 0) fail(system_problem());
  if (!in_place && !fs::is_directory(needed, ignored)) fail(std::strerror(ENOTDIR));
}

}  // namespace isotherm
