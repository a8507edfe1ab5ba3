#include "isotherm/geometry/points/point_cloud.hpp"
#include "reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return read_untrusted(data, size,
                        [](auto& reader, const auto&) { isotherm::geometry::read_points(reader); });
}
