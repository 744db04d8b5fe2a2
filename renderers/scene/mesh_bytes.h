#pragma once

#include "perception/base/errors.h"

#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

namespace renderers::scene {

/// Little-endian value at a place that lies inside a binary mesh file's data.
template <typename T>
T value_at(std::string_view data, std::size_t offset) {
  T value;
  std::memcpy(&value, data.data() + offset, sizeof(T));
  return value;
}

/// @throws base::InputError  always: the file (or a part of it) ends too early
[[noreturn]] inline void fail_truncated(const std::string& file, std::size_t needed_bytes,
                                        std::size_t present_bytes) {
  throw base::InputError(file + ": truncated: needs " + std::to_string(needed_bytes) +
                         " bytes, has " + std::to_string(present_bytes));
}

}  // namespace renderers::scene
