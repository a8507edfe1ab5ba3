#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "isotherm/base/error.hpp"

namespace isotherm {

/// Reads text line by line and token by token, and knows where it stands.
///
/// One pass and one buffer: memory does not grow with the input. Compressed
/// input (gzip) is recognised by its content. Lines end in LF or CRLF, the last
/// one also at the end of the input; tokens are separated by blanks and tabs.
/// Numbers are parsed without regard to the locale and rounded correctly. Every
/// error names path, line, column, token and what was expected.
class TextReader {
 public:
  /// A longer line is an error: it is no text this library reads.
  static constexpr std::size_t kLongestLine = std::size_t{1} << 20;

  /// How far `peek` looks ahead, in bytes.
  static constexpr std::size_t kLookAhead = std::size_t{1} << 16;

  /// Opens `path`, or standard input where it is "-".
  /// @throws FileError if it cannot be opened.
  explicit TextReader(const std::string& path);

  /// Reads `text` from memory, which must outlive the reader; `name` stands for
  /// the path in messages.
  TextReader(std::string name, std::string_view text);

  /// Fills the span as far as it can; 0 at the end of the input.
  using Source = std::function<std::size_t(std::span<char>)>;

  /// Reads a part of the text called `name`, which has `lines_before` lines in front of it.
  TextReader(std::string name, Source source, std::uint64_t lines_before);

  TextReader(TextReader&&) = default;
  TextReader& operator=(TextReader&&) = default;

  const std::string& path() const noexcept { return path_; }

  /// What comes next without consuming it: at least `kLookAhead` bytes or all
  /// that is left. For telling formats apart before the first line.
  std::string_view peek();

  /// Tokens are from now on separated by `separator` as well as by blanks.
  void set_separator(char separator) noexcept { separator_ = separator; }

  /// Goes to the next line and to its first token; false at the end of input.
  /// @throws FileError if reading fails, ParseError for an endless line.
  bool next_line();

  /// The next bytes as they are, for what is no text: as many as the span holds, fewer at the end
  /// of the input. @throws FileError if reading fails
  std::size_t bytes(std::span<char> target);

  /// Number of the current line, from 1.
  std::uint64_t line_number() const noexcept { return line_number_; }

  /// The current line without its end. Valid until next_line().
  std::string_view line() const noexcept {
    return {line_begin_, static_cast<std::size_t>(line_end_ - line_begin_)};
  }

  /// Whether only blanks are left on the line.
  bool at_line_end();

  /// The next token, or an empty view at the end of the line.
  std::string_view word();

  /// The next token. @throws ParseError "expected <what>" at the end of the line.
  std::string_view word(std::string_view what);

  /// The next token as a finite number.
  /// @throws ParseError unless it is one; `what` says what it stands for.
  double number(std::string_view what);

  /// The next token as an integer in [0, 2^64).
  /// @throws ParseError unless it is one.
  std::uint64_t unsigned_integer(std::string_view what);

  /// @throws ParseError if a token is left on the line.
  void expect_line_end();

  /// The text of the line from `column` to the end of the last token read.
  std::string_view text_from(std::uint64_t column) const;

  /// Where the last token read stands.
  SourceLocation location() const;

  /// @throws ParseError at the last token read.
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  bool fill();
  bool is_blank(char c) const noexcept { return c == ' ' || c == '\t' || c == separator_; }
  void skip_blanks() noexcept;
  [[noreturn]] void fail_expected(std::string_view what, std::string_view kind);

  std::string path_;
  Source source_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;  // unread part of the buffer
  std::size_t end_ = 0;
  bool source_ended_ = false;
  char separator_ = ' ';
  std::uint64_t line_number_ = 0;
  const char* line_begin_ = nullptr;
  const char* line_end_ = nullptr;
  const char* cursor_ = nullptr;
  const char* token_begin_ = nullptr;
  const char* token_end_ = nullptr;
};

/// All that is in `path` ("-" is standard input), decompressed.
/// @throws FileError
std::string read_whole(const std::string& path);

/// `text` as a finite number, or nothing: decimal, an optional sign and an
/// exponent of any length. No blanks around it.
bool parse_number(std::string_view text, double& value) noexcept;

/// `text` as an integer in [0, 2^64), or nothing.
bool parse_unsigned(std::string_view text, std::uint64_t& value) noexcept;

/// The stretches of `line` between runs of `separators`.
std::vector<std::string_view> split(std::string_view line, std::string_view separators);

}  // namespace isotherm
