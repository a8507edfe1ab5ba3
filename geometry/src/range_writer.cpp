#include <cmath>

#include "isotherm/base/text_writer.hpp"
#include "isotherm/geometry/range_file.hpp"

namespace isotherm::geometry {

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

}  // namespace isotherm::geometry
