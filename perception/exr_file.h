#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "perception/image_file.h"

namespace perception {

/// Reads every part and layer of an OpenEXR file. Internal: use image_file.h.
///
/// The pixels lie in the display window; what the data window leaves open is 0, what it holds
/// outside is dropped. Half and unsigned values become float. R, G, B, A come first, then the
/// other channels by name. A channel "layer.R" belongs to the part "layer"; the channels without a
/// layer come first, under the part's own name ("" if it has none). Chromaticities are not applied.
/// @throws base::InputError naming file and reason
ImageFile read_exr(const std::filesystem::path& path, std::optional<Encoding> encoding);

/// The bytes of a float32 ZIP multi-part EXR; the same for the same file, always.
///
/// @param name  the file's name, for messages
/// @throws base::InputError if parts are missing, differ in size, or share a name
std::string exr_bytes(const std::filesystem::path& name, const ImageFile& file);

}  // namespace perception
