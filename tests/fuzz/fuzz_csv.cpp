#include <utility>

#include "isotherm/base/csv.hpp"
#include "reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return read_untrusted(data, size, [](auto& reader, const auto&) {
    isotherm::CsvReader csv(std::move(reader));
    const auto edge = csv.column("edge", 0);
    const auto score = csv.column("score", 1);
    while (csv.next_row()) {
      csv.unsigned_integer(edge, "an edge");
      csv.number(score, "a score");
    }
  });
}
