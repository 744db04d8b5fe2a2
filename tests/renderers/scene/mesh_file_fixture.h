#pragma once

#include "renderers/scene/mesh_file.h"
#include "tests/expect_input_error.h"
#include "tests/renderers/scene/scene_text.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace renderers::scene {

/// Writes small mesh files and reads them.
class MeshFile : public ::testing::Test {
 protected:
  std::filesystem::path file(const std::string& name, std::string_view bytes) {
    const auto path = folder_.path() / name;
    tests::write(path, bytes);
    return path;
  }

  Mesh read(const std::filesystem::path& path, const MeshFileOptions& options = {}) {
    return read_mesh_file(path, options, warnings_);
  }

  /// The message of reading a file, without the folder.
  std::string error_of(const std::string& name, std::string_view bytes) {
    const auto path = file(name, bytes);
    std::string message = tests::input_error_of([&] { read(path); });
    const std::string prefix = folder_.path().string() + "/";
    return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
  }

  tests::TemporaryFolder folder_;
  std::vector<std::string> warnings_;
};

/// Appends a little-endian value.
inline void append_u16(std::string& bytes, unsigned value) {
  bytes += static_cast<char>(value & 0xFFU);
  bytes += static_cast<char>(value >> 8U);
}

/// Appends a little-endian value.
inline void append_u32(std::string& bytes, std::size_t value) {
  append_u16(bytes, static_cast<unsigned>(value & 0xFFFFU));
  append_u16(bytes, static_cast<unsigned>(value >> 16U));
}

}  // namespace renderers::scene
