#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "isotherm/base/error.hpp"

namespace isotherm {

/// How every reader treats what is not quite right.
struct ReadOptions {
  /// Whether a repair is an error. Default: what has one obvious repair is
  /// repaired and counted.
  bool strict = false;

  void validate() const {}
};

template <class Visitor>
void visit_fields(ReadOptions& options, Visitor&& visitor) {
  visitor("strict", options.strict, "Treat every repair of the input as an error");
}

/// One thing noticed while reading.
struct Diagnostic {
  std::string kind;  ///< a name that groups diagnostics, e.g. "angle wrapped"
  SourceLocation where;
  std::string token;    ///< what the input says there; may be empty
  std::string message;  ///< what is unusual, and what was done about it
};

/// `where: message (got 'token')`.
std::string to_string(const Diagnostic& diagnostic);

/// What a reader found, beside the data.
struct ReadReport {
  /// So many diagnostics of a kind are kept; further ones are only counted.
  static constexpr std::uint64_t kKeptPerKind = 20;

  std::string path;
  std::string format;  ///< e.g. "g2o"
  std::uint64_t lines = 0;
  std::map<std::string, std::uint64_t> records;  ///< understood lines by tag
  std::map<std::string, std::uint64_t> skipped;  ///< lines not understood, by tag
  std::map<std::string, std::uint64_t> repairs;  ///< by kind; errors where strict
  std::map<std::string, std::uint64_t> notes;    ///< by kind; data taken as it is
  std::vector<Diagnostic> diagnostics;           ///< repairs and notes, in order of discovery

  /// Counts a repair. @throws ParseError in its place if `options.strict`.
  void add_repair(const ReadOptions& options, Diagnostic diagnostic);

  /// Counts something unusual that needs no repair.
  void add_note(Diagnostic diagnostic);
};

}  // namespace isotherm
