#include "isotherm/base/text_writer.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fcntl.h>
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

// The file a symbolic link points to, so that renaming does not replace the link.
std::string resolve_links(const std::string& path) {
  std::error_code problem;
  if (!fs::is_symlink(fs::symlink_status(path, problem))) return path;
  const auto target = fs::weakly_canonical(path, problem);
  return problem ? path : target.string();
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
  std::string target;     // what the temporary is renamed to; empty if written directly
  std::string temporary;  // what exists until commit
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
    temporary = temporary_name(target);
    const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0666);
    if (descriptor < 0) {
      temporary.clear();
    } else if (fs::exists(status)) {
      fs::permissions(temporary, status.permissions(), ignored);
    }
    return descriptor;
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

  ~State() {
    if (file != nullptr) gzclose(file);
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
  if (state_->temporary.empty()) return;
  if (std::rename(state_->temporary.c_str(), state_->target.c_str()) != 0) {
    state_->fail(system_problem());
  }
  state_->temporary.clear();
}

}  // namespace isotherm
