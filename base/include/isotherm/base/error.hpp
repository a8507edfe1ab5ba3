#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace isotherm {

/// Base of every exception this library throws on purpose.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An argument or option field is outside its documented range.
class InvalidArgument : public Error {
 public:
  /// `option` is the field or parameter name; `problem` says what was expected.
  InvalidArgument(std::string option, const std::string& problem);

  const std::string& option() const noexcept { return option_; }

 private:
  std::string option_;
};

/// Where in an input a problem stands. Lines and columns count from 1; 0 means
/// that the problem concerns the whole line or file.
struct SourceLocation {
  std::string path;
  std::uint64_t line = 0;
  std::uint64_t column = 0;
};

/// Input text that cannot be understood. The message has the form
/// `path:line:column: problem (got 'token')`.
class ParseError : public Error {
 public:
  ParseError(SourceLocation where, std::string token, const std::string& problem);

  const std::string& path() const noexcept { return where_.path; }
  std::uint64_t line() const noexcept { return where_.line; }
  std::uint64_t column() const noexcept { return where_.column; }
  const std::string& token() const noexcept { return token_; }

 private:
  SourceLocation where_;
  std::string token_;
};

/// A file that cannot be opened, read or written.
class FileError : public Error {
 public:
  FileError(std::string path, const std::string& problem);

  const std::string& path() const noexcept { return path_; }

 private:
  std::string path_;
};

/// A computation that cannot give a usable value (a singular system, say).
class NumericalError : public Error {
 public:
  /// `stage` names the computation, e.g. "cholesky".
  NumericalError(std::string stage, const std::string& problem);

  const std::string& stage() const noexcept { return stage_; }

 private:
  std::string stage_;
};

/// A progress callback asked the computation to stop.
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled") {}
};

/// `where` as `path:line:column`, leaving out what is zero.
std::string to_string(const SourceLocation& where);

}  // namespace isotherm
