#include "isotherm/base/text_reader.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

#include <fast_float/fast_float.h>
#include <unistd.h>
#include <zlib.h>

namespace isotherm {
namespace {

constexpr std::size_t kFirstBufferSize = std::size_t{1} << 18;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::shared_ptr<gzFile_s> open_gzip(const std::string& path) {
  std::error_code ignored;
  if (path != "-" && std::filesystem::is_directory(path, ignored)) {
    throw FileError(path, "is a directory");
  }
  errno = 0;
  gzFile file = nullptr;
  if (path == "-") {
    // A copy of the descriptor, since closing the file closes it.
    if (const int descriptor = ::dup(STDIN_FILENO); descriptor >= 0) {
      file = gzdopen(descriptor, "rb");
    }
  } else {
    file = gzopen(path.c_str(), "rb");
  }
  if (file == nullptr) {
    throw FileError(path, std::string("cannot be opened: ") +
                              (errno != 0 ? std::strerror(errno) : "out of memory"));
  }
  gzbuffer(file, 256 * 1024);
  return {file, [](gzFile open) { gzclose(open); }};
}

// Number of bytes read, 0 at the end.
std::size_t read_some(gzFile file, const std::string& name, std::span<char> target) {
  const int count = gzread(file, target.data(), static_cast<unsigned>(target.size()));
  int code = Z_OK;
  const char* problem = gzerror(file, &code);
  if (count < 0 || (count == 0 && code != Z_OK && code != Z_STREAM_END)) {
    std::string_view reason = code == Z_ERRNO ? std::strerror(errno) : problem;
    // zlib puts the path in front of its own messages.
    if (const auto colon = reason.find(": "); colon != reason.npos) {
      reason.remove_prefix(colon + 2);
    }
    throw FileError(name, "cannot be read: " + std::string(reason));
  }
  return static_cast<std::size_t>(count);
}

// Leaves `first` behind an optional plus sign, which from_chars does not take.
bool skip_plus(const char*& first, const char* last) noexcept {
  if (first == last || *first != '+') return true;
  ++first;
  return first != last && *first != '-' && *first != '+';
}

// Parses a number at the start of [first, last); returns where it ends, or
// nullptr if there is no finite number.
const char* parse_number_prefix(const char* first, const char* last, double& value) noexcept {
  if (!skip_plus(first, last)) return nullptr;
  const auto result = fast_float::from_chars(first, last, value);
  // A value too small for a double is 0; one too large is infinite.
  if (result.ec == std::errc::invalid_argument || !std::isfinite(value)) return nullptr;
  return result.ptr;
}

}  // namespace

bool parse_number(std::string_view text, double& value) noexcept {
  const char* last = text.data() + text.size();
  return !text.empty() && parse_number_prefix(text.data(), last, value) == last;
}

bool parse_unsigned(std::string_view text, std::uint64_t& value) noexcept {
  const char* last = text.data() + text.size();
  const auto result = std::from_chars(text.data(), last, value);
  return result.ec == std::errc() && result.ptr == last;
}

TextReader::TextReader(const std::string& path) : path_(path == "-" ? "<stdin>" : path) {
  source_ = [file = open_gzip(path), name = path_](std::span<char> target) {
    return read_some(file.get(), name, target);
  };
}

std::string read_whole(const std::string& path) {
  const auto file = open_gzip(path);
  const std::string name = path == "-" ? "<stdin>" : path;
  std::string text;
  for (std::size_t end = 0;;) {
    text.resize(end + kFirstBufferSize);
    const std::size_t count = read_some(file.get(), name, std::span(text).subspan(end));
    end += count;
    text.resize(end);
    if (count == 0) return text;
  }
}

TextReader::TextReader(std::string name, std::string_view text) : path_(std::move(name)) {
  source_ = [text](std::span<char> target) mutable {
    const std::size_t count = std::min(text.size(), target.size());
    std::copy_n(text.begin(), count, target.begin());
    text.remove_prefix(count);
    return count;
  };
}

TextReader::TextReader(std::string name, Source source, std::uint64_t lines_before)
    : path_(std::move(name)), source_(std::move(source)), line_number_(lines_before) {}

// Moves what is unread to the front and reads on; false if nothing was added.
bool TextReader::fill() {
  if (source_ended_) return false;
  if (buffer_.empty()) buffer_.resize(kFirstBufferSize);
  if (begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  // Only a line longer than the buffer, or a look ahead, makes it grow.
  if (end_ == buffer_.size()) buffer_.resize(2 * buffer_.size());
  const bool first_bytes = line_number_ == 0 && end_ == 0;
  const std::size_t count = source_(std::span(buffer_).subspan(end_));
  end_ += count;
  source_ended_ = count == 0;
  if (first_bytes && std::string_view(buffer_.data(), end_).starts_with(kByteOrderMark)) {
    begin_ = kByteOrderMark.size();
  }
  return count > 0;
}

std::string_view TextReader::peek() {
  while (end_ - begin_ < kLookAhead && fill()) {
  }
  return {buffer_.data() + begin_, end_ - begin_};
}

std::size_t TextReader::bytes(std::span<char> target) {
  std::size_t count = 0;
  while (count < target.size()) {
    if (begin_ == end_ && !fill()) break;
    const std::size_t some = std::min(target.size() - count, end_ - begin_);
    std::memcpy(target.data() + count, buffer_.data() + begin_, some);
    begin_ += some;
    count += some;
  }
  return count;
}

bool TextReader::next_line() {
  std::size_t searched = 0;
  const char* newline = nullptr;
  while (true) {
    if (end_ - begin_ > searched) {
      newline = static_cast<const char*>(
          std::memchr(buffer_.data() + begin_ + searched, '\n', end_ - begin_ - searched));
    }
    if (newline != nullptr) break;
    searched = end_ - begin_;
    if (searched > kLongestLine) {
      throw ParseError({path_, line_number_ + 1, 0}, "",
                       "line longer than " + std::to_string(kLongestLine) + " bytes");
    }
    if (!fill()) break;
  }
  if (newline == nullptr && begin_ == end_) return false;

  line_begin_ = buffer_.data() + begin_;
  line_end_ = newline != nullptr ? newline : buffer_.data() + end_;
  begin_ = static_cast<std::size_t>(line_end_ - buffer_.data()) + (newline != nullptr ? 1 : 0);
  if (line_end_ != line_begin_ && line_end_[-1] == '\r') --line_end_;
  cursor_ = token_begin_ = token_end_ = line_begin_;
  ++line_number_;
  return true;
}

void TextReader::skip_blanks() noexcept {
  while (cursor_ != line_end_ && is_blank(*cursor_)) ++cursor_;
}

bool TextReader::at_line_end() {
  skip_blanks();
  return cursor_ == line_end_;
}

std::string_view TextReader::word() {
  skip_blanks();
  token_begin_ = cursor_;
  while (cursor_ != line_end_ && !is_blank(*cursor_)) ++cursor_;
  token_end_ = cursor_;
  return {token_begin_, static_cast<std::size_t>(token_end_ - token_begin_)};
}

std::string_view TextReader::word(std::string_view what) {
  const auto token = word();
  if (token.empty()) fail("expected " + std::string(what) + ", found the end of the line");
  return token;
}

double TextReader::number(std::string_view what) {
  skip_blanks();
  double value = 0.0;
  const char* number_end =
      cursor_ != line_end_ ? parse_number_prefix(cursor_, line_end_, value) : nullptr;
  if (number_end == nullptr || (number_end != line_end_ && !is_blank(*number_end))) {
    fail_expected(what, "a finite number");
  }
  token_begin_ = cursor_;
  token_end_ = cursor_ = number_end;
  return value;
}

std::uint64_t TextReader::unsigned_integer(std::string_view what) {
  skip_blanks();
  std::uint64_t value = 0;
  const auto result = std::from_chars(cursor_, line_end_, value);
  if (result.ec != std::errc() || (result.ptr != line_end_ && !is_blank(*result.ptr))) {
    fail_expected(what, "an integer in [0, 2^64)");
  }
  token_begin_ = cursor_;
  token_end_ = cursor_ = result.ptr;
  return value;
}

void TextReader::expect_line_end() {
  if (!at_line_end()) {
    word();
    fail("expected the end of the line");
  }
}

std::string_view TextReader::text_from(std::uint64_t column) const {
  const char* first = line_begin_ + std::min<std::size_t>(column - 1, token_end_ - line_begin_);
  return {first, static_cast<std::size_t>(token_end_ - first)};
}

SourceLocation TextReader::location() const {
  return {path_, line_number_, static_cast<std::uint64_t>(token_begin_ - line_begin_) + 1};
}

void TextReader::fail(const std::string& problem) const {
  throw ParseError(location(), std::string(token_begin_, token_end_), problem);
}

void TextReader::fail_expected(std::string_view what, std::string_view kind) {
  const bool semicolons = word(what).find(';') != std::string_view::npos;
  fail("expected " + std::string(what) + ", " + std::string(kind) +
       (semicolons ? "; semicolons separate nothing here" : ""));
}

std::vector<std::string_view> split(std::string_view line, std::string_view separators) {
  std::vector<std::string_view> parts;
  auto begin = line.find_first_not_of(separators);
  while (begin != std::string_view::npos) {
    const auto end = std::min(line.find_first_of(separators, begin), line.size());
    parts.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(separators, end);
  }
  return parts;
}

}  // namespace isotherm
