#include "perception/image_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <fstream>

#include <fmt/format.h>

#include "perception/base/atomic_file.h"
#include "perception/base/errors.h"
#include "perception/exr_file.h"
#include "perception/image_module.h"
#include "perception/pfm_file.h"

namespace perception {
namespace {

/// First bytes of an OpenEXR file ("OpenEXR File Layout", magic number 20000630).
constexpr std::array<unsigned char, 4> kExrMagic{0x76, 0x2f, 0x31, 0x01};

constexpr std::string_view kPngMagic{"\x89PNG\r\n\x1a\n"};

const std::vector<std::string> kExtensions{"exr", "png",  "jpg", "jpeg", "hdr", "pfm",
                                           "tif", "tiff", "tga", "bmp",  "ppm", "pgm"};

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// The extension of a file that is there, has bytes and is of a known kind.
std::string checked_extension(const std::filesystem::path& path) {
  const auto fail = [&path](const std::string& reason) {
    throw base::InputError(
        fmt::format("{}: cannot be read as an image: {}", path.string(), reason));
  };
  const std::string extension = extension_of(path);
  if (std::find(kExtensions.begin(), kExtensions.end(), extension) == kExtensions.end()) {
    throw base::InputError(fmt::format("{}: {}", path.string(),
                                       base::unknown_name("image format", extension, kExtensions)));
  }
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) fail("there is no such file");
  if (error) fail(error.message());
  if (std::filesystem::is_directory(status)) fail("it is a folder");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail("it cannot be opened");
  std::array<char, 4> head{};
  stream.read(head.data(), head.size());
  if (stream.gcount() == 0) fail("the file is empty");
  const bool is_exr = std::equal(head.begin(), head.end(), kExrMagic.begin(),
                                 [](char a, auto b) { return static_cast<unsigned char>(a) == b; });
  if (extension == "exr" && !is_exr) {
    fail("it is not an EXR file, whose first bytes are 76 2f 31 01");
  }
  return is_exr ? "exr" : extension;
}

/// Refuses a PNG without its last chunk: libpng would say so on stderr, and OpenImageIO leak.
void check_png_end(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::array<char, 8> head{};
  stream.read(head.data(), head.size());
  if (std::string_view(head.data(), kPngMagic.size()) != kPngMagic) return;
  constexpr std::uintmax_t kChecksumBytes = 4;
  const std::uintmax_t size = std::filesystem::file_size(path);
  std::uintmax_t position = head.size();
  // A chunk is its size (big-endian), its name, its data, a checksum.
  while (stream.seekg(static_cast<std::streamoff>(position)) &&
         stream.read(head.data(), head.size())) {
    std::uintmax_t chunk_bytes = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      chunk_bytes = (chunk_bytes << 8U) | static_cast<unsigned char>(head[i]);
    }
    position += head.size() + chunk_bytes + kChecksumBytes;
    if (position <= size && std::string_view(head.data() + 4, 4) == "IEND") return;
  }
  throw base::InputError(
      fmt::format("{}: cannot be read as an image: the PNG file is truncated", path.string()));
}

PngSource png_source(const Image& image) {
  const int channels = image.channel_count();
  if (image.encoding != Encoding::display || (channels != 1 && channels != 3 && channels != 4)) {
    throw base::InputError(fmt::format(
        "a PNG cannot hold an image of {} channels with the encoding {}; accepted: 1, 3 "
        "or 4 channels, display",
        channels, to_string(image.encoding)));
  }
  PngSource source{image.width_px, image.height_px, channels, {}, 0};
  source.pixels.reserve(image.pixels.size());
  for (const float value : image.pixels) {
    const float clipped = std::isnan(value) ? 0.0F : std::clamp(value, 0.0F, 1.0F);
    source.pixels.push_back(static_cast<unsigned char>(std::lround(clipped * 255.0F)));
  }
  return source;
}

}  // namespace

ImageFile read_image_file(const std::filesystem::path& path, std::optional<Encoding> encoding) {
  const std::string extension = checked_extension(path);
  if (extension == "exr") return read_exr(path, encoding);
  if (extension == "pfm") return read_pfm(path, encoding);
  check_png_end(path);
  return decode_with_module(image_module_folders(), path, encoding);
}

Image read_image(const std::filesystem::path& path, std::optional<Encoding> encoding) {
  return std::move(read_image_file(path, encoding).parts.front().image);
}

void write_exr(const std::filesystem::path& path, const ImageFile& file) {
  base::write_text_file(path, exr_bytes(path, file));
}

void write_png(const std::filesystem::path& path, const Image& image) {
  base::write_text_file(path, png_bytes(image));
}

std::string png_bytes(const Image& image) {
  return encode_png_with_module(image_module_folders(), png_source(image));
}

std::string jpeg_bytes(const Image& image, int quality) {
  if (image.channel_count() != 1 && image.channel_count() != 3) {
    throw base::InputError(fmt::format(
        "a JPEG cannot hold an image of {} channels; accepted: 1 or 3", image.channel_count()));
  }
  PngSource source = png_source(image);
  source.jpeg_quality = quality;
  return encode_png_with_module(image_module_folders(), source);
}

}  // namespace perception
