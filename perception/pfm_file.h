#pragma once

#include <filesystem>
#include <optional>

#include "perception/image_file.h"

namespace perception {

/// Reads a portable float map: "PF" (R, G, B) or "Pf" (Y), either byte order, stored bottom row
/// first. The scale's sign gives the byte order; its size is not applied, as is the custom.
/// Encoding scene_linear unless given. Internal: use image_file.h.
/// @throws base::InputError naming file and reason
/// Source: "PFM Portable FloatMap Image Format", as Netpbm documents it.
ImageFile read_pfm(const std::filesystem::path& path, std::optional<Encoding> encoding);

}  // namespace perception
