#include "isotherm/base/error.hpp"

#include <string_view>
#include <utility>

namespace isotherm {
namespace {

// Long or binary tokens would bury the message; show the start, made printable.
std::string printable(std::string_view token) {
  constexpr std::size_t kLongest = 40;
  std::string shown;
  for (const char c : token.substr(0, kLongest)) {
    shown += (c >= ' ' && c <= '~') ? c : '?';
  }
  if (token.size() > kLongest) shown += "...";
  return shown;
}

std::string parse_message(const SourceLocation& where, const std::string& token,
                          const std::string& problem) {
  std::string message = to_string(where) + ": " + problem;
  if (!token.empty()) message += " (got '" + printable(token) + "')";
  return message;
}

}  // namespace

InvalidArgument::InvalidArgument(std::string option, const std::string& problem)
    : Error(option + ": " + problem), option_(std::move(option)) {}

ParseError::ParseError(SourceLocation where, std::string token, const std::string& problem)
    : Error(parse_message(where, token, problem)),
      where_(std::move(where)),
      token_(std::move(token)) {}

FileError::FileError(std::string path, const std::string& problem)
    : Error(path + ": " + problem), path_(std::move(path)) {}

NumericalError::NumericalError(std::string stage, const std::string& problem)
    : Error(stage + ": " + problem), stage_(std::move(stage)) {}

std::string to_string(const SourceLocation& where) {
  std::string text = where.path;
  if (where.line > 0) {
    text += ':' + std::to_string(where.line);
    if (where.column > 0) text += ':' + std::to_string(where.column);
  }
  return text;
}

}  // namespace isotherm
