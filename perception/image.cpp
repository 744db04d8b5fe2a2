#include "perception/image.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "perception/base/errors.h"
#include "perception/base/hash.h"
#include "perception/base/names.h"

namespace perception {
namespace {

constexpr std::array<Encoding, 3> kEncodings{Encoding::scene_linear, Encoding::luminance_cd_m2,
                                             Encoding::display};

bool is_same_channel(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
    return std::toupper(x) == std::toupper(y);
  });
}

/// Source channels of R, G, B; the one channel beside alpha stands for all three.
std::array<int, 3> rgb_channels(const Image& image) {
  const std::array<int, 3> rgb{channel_index(image, "R"), channel_index(image, "G"),
                               channel_index(image, "B")};
  if (std::find(rgb.begin(), rgb.end(), -1) == rgb.end()) return rgb;
  int only = -1;
  int count = 0;
  for (int c = 0; c < image.channel_count(); ++c) {
    if (is_same_channel(image.channels[static_cast<std::size_t>(c)], "A")) continue;
    only = c;
    ++count;
  }
  if (count == 1) return {only, only, only};
  throw base::InputError(
      fmt::format("no colour in an image with the channels {}; accepted: R, G, B, or one channel",
                  fmt::join(image.channels, ", ")));
}

}  // namespace

std::string to_string(Encoding encoding) {
  switch (encoding) {
    case Encoding::scene_linear:
      return "scene_linear";
    case Encoding::luminance_cd_m2:
      return "luminance_cd_m2";
    case Encoding::display:
      return "display";
  }
  assert(false);
  return "";
}

Encoding encoding_from_text(std::string_view text) {
  std::vector<std::string> known;
  for (const Encoding encoding : kEncodings) {
    known.push_back(to_string(encoding));
    if (base::is_same_name(known.back(), text)) return encoding;
  }
  throw base::InputError(base::unknown_name("encoding", text, known));
}

Image::Image(int width, int height, std::vector<std::string> channel_names, Encoding meaning)
    : width_px(width), height_px(height), channels(std::move(channel_names)), encoding(meaning) {
  assert(width > 0 && height > 0 && !channels.empty());
  pixels.resize(pixel_count() * channels.size());
}

Image make_rgb_image(int width_px, int height_px, Encoding encoding) {
  return Image(width_px, height_px, {"R", "G", "B"}, encoding);
}

Image make_gray_image(int width_px, int height_px, const std::string& channel, Encoding encoding) {
  return Image(width_px, height_px, {channel}, encoding);
}

int channel_index(const Image& image, std::string_view channel) {
  for (std::size_t c = 0; c < image.channels.size(); ++c) {
    if (is_same_channel(image.channels[c], channel)) return static_cast<int>(c);
  }
  return -1;
}

Image rgb_of(const Image& image) {
  const std::array<int, 3> source = rgb_channels(image);
  Image rgb = make_rgb_image(image.width_px, image.height_px, image.encoding);
  if (image.channel_count() == 3 && source == std::array{0, 1, 2}) {
    rgb.pixels = image.pixels;
    return rgb;
  }
  const std::size_t stride = image.channels.size();
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      rgb.pixels[3 * i + c] = image.pixels[stride * i + static_cast<std::size_t>(source[c])];
    }
  }
  return rgb;
}

Image crop(const Image& image, int x_px, int y_px, int width_px, int height_px) {
  // Compared as differences, so that huge values cannot overflow.
  if (x_px < 0 || y_px < 0 || width_px < 1 || height_px < 1 || x_px > image.width_px - width_px ||
      y_px > image.height_px - height_px) {
    throw base::InputError(fmt::format(
        "region {},{},{},{} (x,y,width,height) leaves the image; accepted: within {}x{} "
        "pixels, at least 1x1",
        x_px, y_px, width_px, height_px, image.width_px, image.height_px));
  }
  Image part(width_px, height_px, image.channels, image.encoding);
  const std::size_t row = static_cast<std::size_t>(width_px) * image.channels.size();
  for (int y = 0; y < height_px; ++y) {
    std::copy_n(image.pixels.begin() + static_cast<std::ptrdiff_t>(image.offset(x_px, y_px + y)),
                row, part.pixels.begin() + static_cast<std::ptrdiff_t>(part.offset(0, y)));
  }
  return part;
}

NonFinite count_non_finite(const Image& image) {
  NonFinite found;
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      const std::span<const float> pixel = image.pixel(x, y);
      if (std::all_of(pixel.begin(), pixel.end(), [](float v) { return std::isfinite(v); })) {
        continue;
      }
      if (found.pixels == 0) {
        found.first_x_px = x;
        found.first_y_px = y;
      }
      ++found.pixels;
    }
  }
  return found;
}

std::string pixel_hash(const Image& image) {
  base::Hasher hasher;
  hasher.add(std::int64_t{image.width_px});
  hasher.add(std::int64_t{image.height_px});
  hasher.add(static_cast<std::int64_t>(image.channels.size()));
  for (const std::string& channel : image.channels) hasher.add(std::string_view(channel));
  hasher.add(std::string_view(to_string(image.encoding)));
  hasher.add(std::span<const float>(image.pixels));
  return hasher.finish().hex();
}

}  // namespace perception
