#include "isotherm/base/read_report.hpp"

#include <utility>

namespace isotherm {
namespace {

void add(std::map<std::string, std::uint64_t>& counts, std::vector<Diagnostic>& kept,
         Diagnostic&& diagnostic) {
  if (counts[diagnostic.kind]++ < ReadReport::kKeptPerKind) kept.push_back(std::move(diagnostic));
}

}  // namespace

std::string to_string(const Diagnostic& diagnostic) {
  return ParseError(diagnostic.where, diagnostic.token, diagnostic.message).what();
}

void ReadReport::add_repair(const ReadOptions& options, Diagnostic diagnostic) {
  if (options.strict) {
    throw ParseError(std::move(diagnostic.where), std::move(diagnostic.token), diagnostic.message);
  }
  add(repairs, diagnostics, std::move(diagnostic));
}

void ReadReport::add_note(Diagnostic diagnostic) { add(notes, diagnostics, std::move(diagnostic)); }

}  // namespace isotherm
