#include <cctype>
#include <cmath>

#include "isotherm/base/text_writer.hpp"
#include "isotherm/network/io/range_file.hpp"

namespace isotherm::network {

namespace {

std::string pyfg_name(const std::string& name) {
  const bool letter = !name.empty() && std::isalpha(static_cast<unsigned char>(name[0])) != 0;
  return letter ? name : "X" + name;
}

std::string position_line(const RangeNetwork& network, Index node) {
  std::string line = network.dimension == 2 ? "VERTEX_XY " : "VERTEX_XYZ ";
  line += pyfg_name(network.names[node]);
  for (const double value : network.positions.col(node)) {
    line += ' ';
    append_number(line, value);
  }
  return line + '\n';
}

std::string range_line(const RangeNetwork& network, const RangeMeasurement& range) {
  std::string line = "EDGE_RANGE ";
  append_number(line, range.timestamp);
  line += ' ' + pyfg_name(network.names[range.from]) + ' ' + pyfg_name(network.names[range.to]);
  for (const double value : {range.distance, range.variance}) {
    line += ' ';
    append_number(line, value);
  }
  return line + '\n';
}

}  // namespace

void write_pyfg(const std::string& path, const RangeNetwork& network) {
  OutputFile file(path);
  for (Index node = 0; node < network.node_count(); ++node) {
    if (network.positions.col(node).allFinite()) file.write(position_line(network, node));
  }
  for (const auto& range : network.ranges) file.write(range_line(network, range));
  file.commit();
}

void write_range_csv(const std::string& path, const RangeNetwork& network) {
  OutputFile file(path);
  file.write("from,to,range,sigma\n");
  std::string row;
  for (const auto& range : network.ranges) {
    row = network.names[range.from] + ',' + network.names[range.to] + ',';
    append_number(row, range.distance);
    row += ',';
    append_number(row, std::sqrt(range.variance));
    row += '\n';
    file.write(row);
  }
  file.commit();
}

}  // namespace isotherm::network
