#pragma once

#include <string>

#include "perception/base/errors.h"

namespace tests {

/// The message of the InputError that a call throws, or "no error" if it throws none.
template <typename Call>
std::string input_error_of(const Call& call) {
  try {
    call();
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace tests
