#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "isotherm/base/error.hpp"

namespace isotherm {

/// Reads JSON (RFC 8259) value by value, and knows where it stands.
///
/// Nothing is kept of what is read, so that memory does not grow with the input. Every error names
/// path, line, column, token and what was expected.
class JsonReader {
 public:
  /// Arrays and objects within each other; more is an error.
  static constexpr int kDeepest = 64;

  /// `text` must outlive the reader; `path` stands for it in messages.
  JsonReader(std::string path, std::string_view text);

  /// Calls `member` with each name of the object that comes next; it must read the value.
  /// @throws ParseError "expected <what>" if none comes, as all that follow
  void object(std::string_view what, const std::function<void(const std::string& name)>& member);

  /// Calls `item` before each value of the array that comes next; it must read the value.
  void array(std::string_view what, const std::function<void()>& item);

  /// Whether an array, an object or null comes next.
  bool at_array() { return peek() == '['; }
  bool at_object() { return peek() == '{'; }
  bool at_null() { return peek() == 'n'; }

  /// Whether nothing but blanks is left. Values may follow each other, as in a log of a line each.
  bool at_end();

  /// A finite number, rounded correctly.
  double number(std::string_view what);

  /// An integer in [0, 2^64).
  std::uint64_t unsigned_integer(std::string_view what);

  std::string string(std::string_view what);

  /// Passes over the value that comes next, whatever it is.
  void skip();

  /// @throws ParseError if anything but blanks is left
  void expect_end();

  /// Where the last value, or the last name of a member, starts.
  SourceLocation location() const;

  /// @throws ParseError there.
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  char peek();
  void begin_token() noexcept;
  std::string_view plain_token();
  void open(char bracket, std::string_view what);
  bool next_item(char close, bool first);
  [[noreturn]] void fail_expected(std::string_view what);
  std::string quoted();
  void escape(std::string& text);
  std::uint32_t code_unit();

  std::string path_;
  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t token_ = 0;  // where the last one starts
  std::size_t line_start_ = 0;
  std::uint64_t line_ = 1;
  std::uint64_t token_line_ = 1;
  std::size_t token_line_start_ = 0;
  int depth_ = 0;
};

}  // namespace isotherm
