#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace isotherm_test {

/// A file that ships with the tests, by its path below tests/data.
std::filesystem::path shipped_data(const std::string& name);

/// The folder of real data sets: $ISOTHERM_DATA, or its default place.
std::filesystem::path real_data_root();

}  // namespace isotherm_test

/// Defines `variable` as the path of a real data file, or skips the test with a message that says
/// what is missing and how to provide it.
#define ISOTHERM_REAL_DATA_OR_SKIP(variable, name)                                 \
  const std::filesystem::path variable = isotherm_test::real_data_root() / (name); \
  if (!std::filesystem::exists(variable)) {                                        \
    GTEST_SKIP() << "no " << variable << "; set ISOTHERM_DATA to the data folder"; \
  }
