#include "isotherm/spectral/graph/graph_file.hpp"
#include "reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return read_untrusted(data, size, [](auto& reader, const auto& options) {
    isotherm::spectral::read_graph(reader, options);
  });
}
