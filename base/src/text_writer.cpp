#include "isotherm/base/text_writer.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include "isotherm/base/error.hpp"
#include "isotherm/base/output_group.hpp"
#include "isotherm/base/output_path.hpp"
#include "temporary_file.hpp"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFlushSize = std::size_t{1} << 18;

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
  std::string path;                                  // as the caller gave it, for messages
  std::unique_ptr<detail::TemporaryFile> temporary;  // none where it is written directly
  std::string pending;
  gzFile file = nullptr;

  [[noreturn]] void fail(const std::string& problem) const {
    throw FileError(path == "-" ? "<stdout>" : path, "cannot be written: " + problem);
  }

  int open_descriptor() {
    if (path == "-") return ::dup(STDOUT_FILENO);
    if (is_endless_link(path)) {
      errno = ELOOP;
      return -1;
    }
    std::error_code ignored;
    const auto status = fs::status(path, ignored);
    if (fs::exists(status) && !fs::is_regular_file(status)) return ::open(path.c_str(), O_WRONLY);
    temporary = std::make_unique<detail::TemporaryFile>(path, output_target(path));
    if (temporary->descriptor() >= 0 && fs::exists(status)) {
      ::fchmod(temporary->descriptor(),
               static_cast<mode_t>(status.permissions() & fs::perms::mask));
    }
    return temporary->descriptor();
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
  auto& temporary = state_->temporary;
  if (temporary != nullptr && !OutputGroup::take(*temporary)) temporary->take_place();
}

}  // namespace isotherm
