#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "perception/image_file.h"

namespace perception {

/// The folders searched for the module of image formats, in order: the executable's folder,
/// ../lib/discern beside it, $DISCERN_MODULE_DIR. Internal: use image_file.h.
std::vector<std::filesystem::path> image_module_folders();

/// Reads any format but EXR and PFM; integers come as [0, 1].
///
/// Encoding: `encoding`, else display for integers and scene_linear for floats.
/// @throws base::InputError if the file cannot be read; base::DeviceError if the module is missing
ImageFile decode_with_module(std::span<const std::filesystem::path> folders,
                             const std::filesystem::path& path, std::optional<Encoding> encoding);

/// 8-bit pixels to be encoded: 1 (Y), 3 (RGB) or 4 (RGBA) channels, interleaved.
struct ByteImage {
  int width_px = 0;
  int height_px = 0;
  int channel_count = 0;
  std::vector<unsigned char> pixels;
  int jpeg_quality = 0;  ///< 1 ... 100: a JPEG, without alpha; 0: a PNG
};

/// @throws base::DeviceError if the module is missing or fails
std::string encode_with_module(std::span<const std::filesystem::path> folders,
                               const ByteImage& source);

}  // namespace perception
