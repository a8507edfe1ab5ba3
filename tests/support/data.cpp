#include "isotherm_test/data.hpp"

#include <cstdlib>

namespace isotherm_test {

std::filesystem::path shipped_data(const std::string& name) {
  return std::filesystem::path(ISOTHERM_TEST_DATA) / name;
}

std::filesystem::path real_data_root() {
  const char* named = std::getenv("ISOTHERM_DATA");
  return named != nullptr ? std::filesystem::path(named)
                          : std::filesystem::path(ISOTHERM_DEFAULT_DATA);
}

}  // namespace isotherm_test
