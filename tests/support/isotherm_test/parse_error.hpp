#pragma once

#include <string>

#include "isotherm/base/error.hpp"

namespace isotherm_test {

/// What the Error says that `action` throws, or "no error".
template <class Action>
std::string message_of(const Action& action) {
  try {
    action();
  } catch (const isotherm::Error& error) {
    return error.what();
  }
  return "no error";
}

/// What the ParseError says that `read` throws, or "no error".
template <class Read>
std::string parse_error_of(const Read& read) {
  try {
    read();
  } catch (const isotherm::ParseError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace isotherm_test
