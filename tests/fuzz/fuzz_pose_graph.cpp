#include "isotherm/slam/io/pose_graph_file.hpp"
#include "reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return read_untrusted(data, size, [](auto& reader, const auto& options) {
    isotherm::slam::read_pose_graph(reader, options);
  });
}
