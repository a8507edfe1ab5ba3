#include <cstdint>
#include <string_view>
#include <unordered_set>

#include "isotherm/base/csv.hpp"
#include "isotherm/base/csv_enum.hpp"
#include "isotherm/base/text_writer.hpp"
#include "isotherm/slam/evaluate/labels.hpp"

namespace isotherm::slam {
void write_labels(const std::string& path, const std::vector<EdgeLabel>& labels) {
  OutputFile file(path);
  file.write("edge,from,to,label\n");
  std::string row;
  for (const auto& label : labels) {
    row.clear();
    append_number(row, label.edge);
    row += ',';
    append_number(row, label.from);
    row += ',';
    append_number(row, label.to);
    row += ',';
    row += enum_name(label.label);
    row += '\n';
    file.write(row);
  }
  file.commit();
}

std::vector<EdgeLabel> read_labels(const std::string& path) {
  CsvReader csv(path);
  std::vector<EdgeLabel> labels;
  std::unordered_set<std::int64_t> seen;
  if (!csv.next_row()) return labels;
  const auto edge = csv.column("edge", 0);
  const auto from = csv.column("from", 1);
  const auto to = csv.column("to", 2);
  const auto label = csv.column("label", 3);
  do {
    EdgeLabel row;
    row.edge = static_cast<std::int64_t>(csv.unsigned_integer(edge, "edge"));
    if (!seen.insert(row.edge).second) csv.fail(edge, "edge occurs twice");
    row.from = csv.unsigned_integer(from, "from");
    row.to = csv.unsigned_integer(to, "to");
    row.label = csv_enum<Label>(csv, label, "label");
    labels.push_back(row);
  } while (csv.next_row());
  return labels;
}

}  // namespace isotherm::slam
