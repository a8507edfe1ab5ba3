#include "isotherm/spectral/edges/verdict_file.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <unordered_set>

#include "isotherm/base/csv.hpp"
#include "isotherm/base/csv_enum.hpp"
#include "isotherm/base/text_writer.hpp"

namespace isotherm::spectral {
namespace {

constexpr std::string_view kHeader = "edge,from,to,verdict,score,threshold,stage";

// A score or threshold may be infinite (nothing was split, say), which CSV
// numbers elsewhere must not be.
double score_field(const CsvReader& csv, std::size_t column, std::string_view what) {
  const auto text = csv.text(column, what);
  if (text == "inf") return std::numeric_limits<double>::infinity();
  if (text == "-inf") return -std::numeric_limits<double>::infinity();
  return csv.number(column, what);
}

// Empty where none is stated, as is all of a file without the column.
double probability_field(const CsvReader& csv, std::optional<std::size_t> column) {
  constexpr std::string_view kWhat = "probability";
  if (!column || csv.text(*column, kWhat).empty()) return std::numeric_limits<double>::quiet_NaN();
  const double value = csv.number(*column, kWhat);
  if (value < 0.0 || value > 1.0) csv.fail(*column, "expected a probability, from 0 to 1");
  return value;
}

void append_fields(std::string& row, const EdgeVerdict& verdict) {
  append_number(row, verdict.edge);
  row += ',';
  append_number(row, verdict.from);
  row += ',';
  append_number(row, verdict.to);
  row += ',';
  row += enum_name(verdict.verdict);
  row += ',';
  append_number(row, verdict.score);
  row += ',';
  append_number(row, verdict.threshold);
  row += ',';
  row += verdict.stage;
}

}  // namespace

void write_verdicts(const std::string& path, const EdgeVerdicts& verdicts,
                    const VertexNames& names) {
  OutputFile file(path);
  const bool probable = state_probabilities(verdicts);
  std::string row;
  file.write(kHeader);
  if (probable) file.write(",probability");
  file.write(names ? ",from_name,to_name\n" : "\n");
  for (const auto& verdict : verdicts) {
    row.clear();
    append_fields(row, verdict);
    if (probable) row += ',';
    if (!std::isnan(verdict.probability)) append_number(row, verdict.probability);
    if (names) row += ',' + names(verdict.from) + ',' + names(verdict.to);
    row += '\n';
    file.write(row);
  }
  file.commit();
}

EdgeVerdicts read_verdicts(const std::string& path) {
  CsvReader csv(path);
  EdgeVerdicts verdicts;
  std::unordered_set<std::int64_t> seen;
  if (!csv.next_row()) return verdicts;
  const auto edge = csv.column("edge", 0);
  const auto from = csv.column("from", 1);
  const auto to = csv.column("to", 2);
  const auto decided = csv.column("verdict", 3);
  const auto score = csv.column("score", 4);
  const auto threshold = csv.column("threshold", 5);
  const auto stage = csv.column("stage", 6);
  const auto probability = csv.find_column("probability");
  do {
    EdgeVerdict row;
    row.edge = static_cast<std::int64_t>(csv.unsigned_integer(edge, "edge"));
    if (!seen.insert(row.edge).second) csv.fail(edge, "edge occurs twice");
    row.from = csv.unsigned_integer(from, "from");
    row.to = csv.unsigned_integer(to, "to");
    row.verdict = csv_enum<Verdict>(csv, decided, "verdict");
    row.score = score_field(csv, score, "score");
    row.threshold = score_field(csv, threshold, "threshold");
    row.stage = csv.text(stage, "stage");
    row.probability = probability_field(csv, probability);
    verdicts.push_back(std::move(row));
  } while (csv.next_row());
  return verdicts;
}

}  // namespace isotherm::spectral
