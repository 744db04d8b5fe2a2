#include "renderers/scene/texture_reader.h"

#include "perception/color_conversion.h"
#include "perception/image_file.h"
#include "renderers/scene/file_locator.h"
#include "renderers/scene/value_reader.h"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace renderers::scene {
namespace {

/// Patterns are images: bilinear lookup blurs their edges by one of these pixels.
constexpr int kPatternPx = 512;
constexpr int kMaxTiles = 128;

struct TwoColors {
  glm::vec3 a{0.0F};
  glm::vec3 b{0.0F};
};

TwoColors read_two_colors(base::MapReader& reader) {
  return {read_color(reader.require("a"), "a"), read_color(reader.require("b"), "b")};
}

/// Fills an image from a function of the pixel's column and row.
template <typename ColorAt>
perception::Image make_pattern(int size_px, ColorAt&& color_at) {
  auto image = perception::make_rgb_image(size_px, size_px, perception::Encoding::scene_linear);
  for (int y = 0; y < size_px; ++y) {
    for (int x = 0; x < size_px; ++x) {
      const glm::vec3 color = color_at(x, y);
      std::ranges::copy(std::array{color.x, color.y, color.z}, image.pixel(x, y).begin());
    }
  }
  return image;
}

/// Side of a pattern that `count` divides, near kPatternPx.
int side_px(int count) { return count * std::max(1, kPatternPx / count); }

perception::Image read_checker(const base::Node& node) {
  base::MapReader reader(node, "checker");
  const TwoColors colors = read_two_colors(reader);
  const int tiles = read_count(reader.require("tiles"), "tiles", 1, kMaxTiles);
  reader.finish();
  const int tile_px = side_px(tiles) / tiles;
  return make_pattern(side_px(tiles), [&](int x, int y) {
    return (x / tile_px + y / tile_px) % 2 == 0 ? colors.a : colors.b;
  });
}

perception::Image read_stripes(const base::Node& node) {
  base::MapReader reader(node, "stripes");
  const TwoColors colors = read_two_colors(reader);
  const int count = read_count(reader.require("count"), "count", 1, kMaxTiles);
  reader.finish();
  const int stripe_px = side_px(count) / count;
  return make_pattern(side_px(count),
                      [&](int x, int) { return (x / stripe_px) % 2 == 0 ? colors.a : colors.b; });
}

/// A value in [0, 1) from two lattice coordinates: the finaliser of SplitMix64 (Steele et al. 2014,
/// doi:10.1145/2660193.2660195).
float lattice_value(std::uint64_t seed, int x, int y) {
  std::uint64_t z = seed + 0x9E3779B97F4A7C15ULL * (static_cast<std::uint64_t>(x) * 65537U +
                                                    static_cast<std::uint64_t>(y) + 1U);
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
  z ^= z >> 31U;
  return static_cast<float>(z >> 40U) / 16777216.0F;
}

/// Value noise with a period of `cells`: lattice values, blended by t^2 (3 - 2 t).
float value_noise(std::uint64_t seed, int cells, float x, float y) {
  const int x0 = static_cast<int>(std::floor(x));
  const int y0 = static_cast<int>(std::floor(y));
  const auto value = [&](int i, int j) { return lattice_value(seed, i % cells, j % cells); };
  const float tx = x - static_cast<float>(x0);
  const float ty = y - static_cast<float>(y0);
  const float sx = tx * tx * (3.0F - 2.0F * tx);
  const float sy = ty * ty * (3.0F - 2.0F * ty);
  const float top = glm::mix(value(x0, y0), value(x0 + 1, y0), sx);
  const float bottom = glm::mix(value(x0, y0 + 1), value(x0 + 1, y0 + 1), sx);
  return glm::mix(top, bottom, sy);
}

perception::Image read_noise(const base::Node& node) {
  base::MapReader reader(node, "noise");
  const TwoColors colors = read_two_colors(reader);
  const int cells = read_count(reader.require("cells"), "cells", 1, kMaxTiles);
  const auto seed = static_cast<std::uint64_t>(reader.integer("seed", 1));
  reader.finish();
  const float per_px = static_cast<float>(cells) / static_cast<float>(kPatternPx);
  return make_pattern(kPatternPx, [&](int x, int y) {
    const float t = value_noise(seed, cells, (static_cast<float>(x) + 0.5F) * per_px,
                                (static_cast<float>(y) + 0.5F) * per_px);
    return glm::mix(colors.a, colors.b, t);
  });
}

/// The image of a file; its error tells which line of the scene asked for it.
perception::Image read_image_for(const std::filesystem::path& path, const base::Place& place) {
  try {
    return perception::read_image(path);
  } catch (const base::InputError& error) {
    throw base::InputError(place, error.what());
  }
}

}  // namespace

perception::Image read_linear_image(const std::filesystem::path& path, const base::Place& place) {
  perception::Image image = perception::linear_rgb_of(read_image_for(path, place));
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const float value = image.pixels[i];
    if (std::isfinite(value) && value >= 0.0F) continue;
    const std::size_t pixel = i / 3;
    const auto width = static_cast<std::size_t>(image.width_px);
    throw base::InputError(place, fmt::format("{}: pixel ({}, {}) is {}; accepted: finite and >= 0",
                                              path.string(), pixel % width, pixel / width, value));
  }
  image.encoding = perception::Encoding::scene_linear;
  return image;
}

Texture read_texture(const base::Node& node, const std::string& name,
                     const std::filesystem::path& folder) {
  base::MapReader reader(node, "texture");
  Texture texture;
  texture.name = name;
  if (const base::Node* checker = reader.find("checker")) {
    texture.image = read_checker(*checker);
  } else if (const base::Node* stripes = reader.find("stripes")) {
    texture.image = read_stripes(*stripes);
  } else if (const base::Node* noise = reader.find("noise")) {
    texture.image = read_noise(*noise);
  } else {
    texture.image = read_linear_image(read_file_reference(reader, folder), node.place());
  }
  reader.finish();
  return texture;
}

glm::vec3 largest_values(const perception::Image& image) {
  glm::vec3 largest(0.0F);
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      const auto pixel = image.pixel(x, y);
      largest = glm::max(largest, glm::vec3(pixel[0], pixel[1], pixel[2]));
    }
  }
  return largest;
}

}  // namespace renderers::scene
