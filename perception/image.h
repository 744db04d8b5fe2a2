#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace perception {

/// What the numbers of an image mean; never implicit.
enum class Encoding {
  scene_linear,     ///< linear Rec.709 primaries, D65; radiance W/(m2 sr) for renderings
  luminance_cd_m2,  ///< absolute light, cd/m2: one channel Y, or linear Rec.709 R, G, B
  display           ///< sRGB-encoded, nominally [0, 1]
};

std::string to_string(Encoding encoding);  ///< "scene_linear", "luminance_cd_m2", "display"
/// @throws base::InputError listing the accepted names
Encoding encoding_from_text(std::string_view text);

/// Float pixels, row-major, top-left first, channels interleaved.
struct Image {
  Image() = default;
  /// Zero-filled. @param channels  e.g. {"R","G","B"}, at least one
  Image(int width_px, int height_px, std::vector<std::string> channels, Encoding encoding);

  int width_px = 0;
  int height_px = 0;
  std::vector<std::string> channels;
  Encoding encoding = Encoding::scene_linear;
  std::vector<float> pixels;  ///< height_px * width_px * channel_count()

  int channel_count() const { return static_cast<int>(channels.size()); }
  std::size_t pixel_count() const {
    return static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  }
  bool is_empty() const { return pixels.empty(); }
  bool has_size_of(const Image& other) const {
    return width_px == other.width_px && height_px == other.height_px;
  }
  /// Offset of the pixel's first channel in `pixels`.
  std::size_t offset(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) +
            static_cast<std::size_t>(x)) *
           channels.size();
  }
  float& at(int x, int y, int channel = 0) {
    return pixels[offset(x, y) + static_cast<std::size_t>(channel)];
  }
  float at(int x, int y, int channel = 0) const {
    return pixels[offset(x, y) + static_cast<std::size_t>(channel)];
  }
  std::span<float> pixel(int x, int y) { return {pixels.data() + offset(x, y), channels.size()}; }
  std::span<const float> pixel(int x, int y) const {
    return {pixels.data() + offset(x, y), channels.size()};
  }
};

/// A three-channel R, G, B image.
Image make_rgb_image(int width_px, int height_px, Encoding encoding);
/// A one-channel image.
Image make_gray_image(int width_px, int height_px, const std::string& channel, Encoding encoding);

/// Index of a channel by name, or -1.
int channel_index(const Image& image, std::string_view channel);

/// The R, G, B channels of an image, by name ("R","G","B", any case); one channel is repeated;
/// others (alpha, depth) are left out.
/// @throws base::InputError if there is neither RGB nor exactly one channel
Image rgb_of(const Image& image);

/// The rectangle as an image of its own. @throws base::InputError if it leaves the image
Image crop(const Image& image, int x_px, int y_px, int width_px, int height_px);

/// Pixels with at least one NaN or infinite channel, and the first of them.
struct NonFinite {
  std::size_t pixels = 0;
  int first_x_px = -1;
  int first_y_px = -1;
};
NonFinite count_non_finite(const Image& image);

/// 32 hex digits over size, channel names, encoding and the bits of every value.
std::string pixel_hash(const Image& image);

}  // namespace perception
