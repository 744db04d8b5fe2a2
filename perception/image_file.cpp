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

/// @param format  for messages: "PNG", "JPEG"
ByteImage byte_image(const Image& image, const char* format, bool may_have_alpha) {
  const int channels = image.channel_count();
  const bool is_known = channels == 1 || channels == 3 || (channels == 4 && may_have_alpha);
  if (image.encoding != Encoding::display || !is_known) {
    throw base::InputError(fmt::format(
        "a {} cannot hold an image of {} channels with the encoding {}; accepted: {} channels, "
        "display",
        format, channels, to_string(image.encoding), may_have_alpha ? "1, 3 or 4" : "1 or 3"));
  }
  ByteImage source{image.width_px, image.height_px, channels, {}, 0};
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
  return encode_with_module(image_module_folders(), byte_image(image, "PNG", true));
}

std::string jpeg_bytes(const Image& image, int quality) {
  if (quality < 1 || quality > 100) {
    throw base::InputError(fmt::format("JPEG quality {}; accepted: 1 to 100", quality));
  }
  ByteImage source = byte_image(image, "JPEG", false);
  source.jpeg_quality = quality;
  return encode_with_module(image_module_folders(), source);
}

}  // namespace perception
