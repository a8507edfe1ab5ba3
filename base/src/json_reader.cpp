#include "isotherm/base/json_reader.hpp"

#include <algorithm>
#include <utility>

#include "isotherm/base/text_reader.hpp"

namespace isotherm {
namespace {

constexpr std::string_view kEnds = " \t\r\n,:[]{}\"";  // of numbers and words
constexpr std::size_t kLongestShown = 40;

constexpr std::uint32_t kFirstHigh = 0xD800;  // surrogates, which are half a code point
constexpr std::uint32_t kFirstLow = 0xDC00;
constexpr std::uint32_t kLastLow = 0xDFFF;

void append_utf8(std::string& text, std::uint32_t code) {
  const auto byte = [&text](std::uint32_t bits) { text += static_cast<char>(bits); };
  const auto rest = [&](int shift) { byte(0x80 | (code >> shift & 0x3F)); };
  if (code < 0x80) return byte(code);
  if (code < 0x800) {
    byte(0xC0 | code >> 6);
  } else if (code < 0x10000) {
    byte(0xE0 | code >> 12);
    rest(6);
  } else {
    byte(0xF0 | code >> 18);
    rest(12);
    rest(6);
  }
  rest(0);
}

}  // namespace

JsonReader::JsonReader(std::string path, std::string_view text)
    : path_(std::move(path)), text_(text) {}

// The first letter of what comes next, behind blanks; 0 at the end.
char JsonReader::peek() {
  for (; at_ < text_.size(); ++at_) {
    const char c = text_[at_];
    if (c != ' ' && c != '\t' && c != '\r' && c != '\n') return c;
    if (c != '\n') continue;
    ++line_;
    line_start_ = at_ + 1;
  }
  return 0;
}

bool JsonReader::at_end() {
  peek();
  return at_ == text_.size();
}

void JsonReader::begin_token() noexcept {
  token_ = at_;
  token_line_ = line_;
  token_line_start_ = line_start_;
}

void JsonReader::open(char bracket, std::string_view what) {
  if (peek() != bracket) fail_expected(what);
  begin_token();
  ++at_;
  if (++depth_ > kDeepest) fail("values are nested deeper than " + std::to_string(kDeepest));
}

// Whether there is another value before `close`, which is passed.
bool JsonReader::next_item(char close, bool first) {
  const char next = peek();
  if (next == close) {
    ++at_;
    --depth_;
    return false;
  }
  if (first) return true;
  if (next != ',') fail_expected(std::string("',' or '") + close + "'");
  ++at_;
  return true;
}

void JsonReader::object(std::string_view what,
                        const std::function<void(const std::string& name)>& member) {
  open('{', what);
  for (bool first = true; next_item('}', first); first = false) {
    const std::string name = string("the name of a member");
    if (peek() != ':') fail_expected("':'");
    ++at_;
    member(name);
  }
}

void JsonReader::array(std::string_view what, const std::function<void()>& item) {
  open('[', what);
  for (bool first = true; next_item(']', first); first = false) item();
}

std::string_view JsonReader::plain_token() {
  peek();
  begin_token();
  const auto end = std::min(text_.find_first_of(kEnds, at_), text_.size());
  return text_.substr(at_, end - at_);
}

double JsonReader::number(std::string_view what) {
  const auto token = plain_token();
  double value = 0.0;
  const bool digit_first = !token.empty() && token.front() != '+' && token.front() != '.';
  if (!digit_first || !parse_number(token, value)) {
    fail_expected(std::string(what) + ", a finite number");
  }
  at_ += token.size();
  return value;
}

std::uint64_t JsonReader::unsigned_integer(std::string_view what) {
  const auto token = plain_token();
  std::uint64_t value = 0;
  if (!parse_unsigned(token, value)) {
    fail_expected(std::string(what) + ", an integer in [0, 2^64)");
  }
  at_ += token.size();
  return value;
}

std::string JsonReader::string(std::string_view what) {
  if (peek() != '"') fail_expected(what);
  begin_token();
  return quoted();
}

std::string JsonReader::quoted() {
  std::string value;
  for (++at_; at_ < text_.size(); ++at_) {
    const char c = text_[at_];
    if (c == '"') {
      ++at_;
      return value;
    }
    if (static_cast<unsigned char>(c) < 0x20) break;
    if (c == '\\') {
      escape(value);
    } else {
      value += c;
    }
  }
  fail("expected a string with its end on the same line");
}

void JsonReader::escape(std::string& text) {
  constexpr std::string_view kLetters = "\"\\/bfnrt";
  constexpr std::string_view kMeanings = "\"\\/\b\f\n\r\t";
  const char letter = ++at_ < text_.size() ? text_[at_] : '\0';
  if (letter != 'u') {
    const auto known = kLetters.find(letter);
    if (known == std::string_view::npos) fail("expected an escape that JSON has");
    text += kMeanings[known];
    return;
  }
  std::uint32_t code = code_unit();
  if (code >= kFirstHigh && code < kFirstLow && text_.substr(at_ + 1, 2) == "\\u") {
    at_ += 2;
    const std::uint32_t low = code_unit();
    if (low < kFirstLow || low > kLastLow) fail("expected the second half of a code point");
    code = 0x10000 + ((code - kFirstHigh) << 10) + (low - kFirstLow);
  }
  if (code >= kFirstHigh && code <= kLastLow) fail("half of a code point alone");
  append_utf8(text, code);
}

// The four digits behind the u that it stands at; ends at the last of them.
std::uint32_t JsonReader::code_unit() {
  constexpr std::string_view kDigits = "0123456789abcdef0123456789ABCDEF";
  std::uint32_t code = 0;
  for (int digit = 0; digit < 4; ++digit) {
    ++at_;
    const auto known = at_ < text_.size() ? kDigits.find(text_[at_]) : std::string_view::npos;
    if (known == std::string_view::npos) fail("expected four hexadecimal digits behind \\u");
    code = code << 4 | static_cast<std::uint32_t>(known % 16);
  }
  return code;
}

void JsonReader::skip() {
  const char next = peek();
  if (next == '{') return object("an object", [this](const std::string&) { skip(); });
  if (next == '[') return array("an array", [this] { skip(); });
  if (next == '"') {
    string("a string");
    return;
  }
  const auto token = plain_token();
  double ignored = 0.0;
  const bool known = token == "true" || token == "false" || token == "null";
  if (!known && !parse_number(token, ignored)) fail_expected("a value");
  at_ += token.size();
}

void JsonReader::expect_end() {
  if (!at_end()) fail_expected("the end of the file");
}

SourceLocation JsonReader::location() const {
  return {path_, token_line_, token_ - token_line_start_ + 1};
}

void JsonReader::fail(const std::string& problem) const {
  const auto token = text_.substr(std::min(token_, text_.size()));
  const bool quoted = token.starts_with('"');
  const auto last = quoted ? token.find('"', 1) : token.find_first_of(kEnds, 1) - 1;
  const auto end = std::min({last, token.size(), kLongestShown}) + 1;
  throw ParseError(location(), std::string(token.substr(0, end)), problem);
}

void JsonReader::fail_expected(std::string_view what) {
  const bool ended = at_end();
  begin_token();
  fail("expected " + std::string(what) + (ended ? ", found the end of the file" : ""));
}

}  // namespace isotherm
