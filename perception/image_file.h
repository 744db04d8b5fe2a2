#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "perception/image.h"

namespace perception {

/// A named image of a multi-part file: the radiance, or an AOV; "" if the file names none.
struct NamedImage {
  std::string name;
  Image image;
};

/// Text and numbers stored with an image, by attribute name ("discern:encoding", ...).
struct Attributes {
  std::map<std::string, std::string> text;
  std::map<std::string, double> number;
};

inline constexpr const char* kEncodingAttribute = "discern:encoding";
inline constexpr const char* kLuminanceScaleAttribute = "discern:luminance_scale_cd_m2";

struct ImageFile {
  std::vector<NamedImage> parts;  ///< at least one; the first is the image itself
  Attributes attributes;
};

/// Reads every part of a file: EXR through OpenEXR, PFM by itself, PNG, JPEG, HDR, TIFF, TGA, BMP,
/// PPM and PGM through OpenImageIO, whose module is opened at the first such file (0.2 s).
///
/// Channels come as R, G, B, A, then the others by name. Integers of n bits are divided by 2^n - 1,
/// exactly; colours are neither converted nor multiplied by alpha. EXR: what the data window leaves
/// open in the display window is 0; a layer "albedo.R" is read as the part "albedo".
/// Encoding of each part: `encoding` if given, else the file's `discern:encoding`, else display
/// for files of integers (PNG, JPEG, ...) and scene_linear for files of floats (EXR, HDR, PFM).
/// @throws base::InputError naming file and reason (missing, truncated, unknown format);
///         base::DeviceError if the module is missing
ImageFile read_image_file(const std::filesystem::path& path,
                          std::optional<Encoding> encoding = std::nullopt);

/// The first part only.
Image read_image(const std::filesystem::path& path,
                 std::optional<Encoding> encoding = std::nullopt);

/// Writes a float32 multi-part EXR (ZIP) atomically; every part's encoding is stored with it. Equal
/// images and attributes give equal bytes.
/// @param file  parts of one size with different names; an only part may have none
/// @throws base::InputError with the system's reason
void write_exr(const std::filesystem::path& path, const ImageFile& file);

/// Writes an 8-bit PNG atomically: round(255 v), v clipped to [0, 1], NaN as 0 (count_non_finite
/// tells). @param image  encoding display; Y, R G B, or R G B A with unassociated alpha
/// @throws base::InputError for other images, or with the system's reason
void write_png(const std::filesystem::path& path, const Image& image);

/// The bytes of an 8-bit PNG, for embedding.
std::string png_bytes(const Image& image);

/// The bytes of an 8-bit JPEG with colours at full resolution; values as for write_png.
/// @param image  encoding display; Y, or R G B  @param quality  1 ... 100, libjpeg's
/// @throws base::InputError for other images
std::string jpeg_bytes(const Image& image, int quality);

}  // namespace perception
