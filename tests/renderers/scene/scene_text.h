#pragma once

#include "perception/base/document.h"
#include "renderers/scene/scene_file.h"

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace tests {

/// A scene with one grey quad; tests replace parts of it.
inline const std::string kSmallScene = R"(schema: 1
scene: small
camera: {position: [0, 0, -3], look_at: [0, 0, 0], vertical_fov_deg: 40}
materials: {grey: {albedo: 0.5}}
objects:
  - {name: plate, quad: {origin: [0, 0, 0], edge_u: [1, 0, 0], edge_v: [0, 1, 0]}, material: grey}
)";

/// The text with the first occurrence of a part replaced; the part must be there.
inline std::string with(std::string text, std::string_view part, std::string_view replacement) {
  const std::size_t at = text.find(part);
  if (at == std::string::npos) throw std::logic_error("no such part: " + std::string(part));
  return text.replace(at, part.size(), replacement);
}

inline renderers::scene::SceneFile parse(const std::string& text,
                                         const std::filesystem::path& folder = {}) {
  return renderers::scene::parse_scene(base::parse_document(text, "small.yaml"), folder);
}

inline void write(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace tests
