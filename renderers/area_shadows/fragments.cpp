#include "renderers/area_shadows/fragments.h"

#include <algorithm>

#include <glm/common.hpp>

namespace renderers::area_shadows {

namespace {

/// Column and row of each quadrant.
constexpr std::array<glm::ivec2, 4> kQuadrants{glm::ivec2(0, 0), glm::ivec2(1, 0), glm::ivec2(1, 1),
                                               glm::ivec2(0, 1)};

}  // namespace

PixelBox pixels_of(const Fragment& fragment, const FragmentSet& set) {
  const glm::ivec2 corner = fragment.corner();
  return {corner, glm::min(corner + fragment.side_px(), glm::ivec2(set.width_px, set.height_px))};
}

Parts parts_of(const Fragment& fragment, const FragmentSet& set) {
  Parts parts;
  for (int quadrant = 0; quadrant < 4; ++quadrant) {
    Fragment part;
    part.level = static_cast<std::int8_t>(fragment.level - 1);
    const glm::ivec2& place = kQuadrants[static_cast<std::size_t>(quadrant)];
    part.x = 2 * fragment.x + place.x;
    part.y = 2 * fragment.y + place.y;
    if (!set.holds(part.corner())) continue;
    parts.quadrants[parts.count] = quadrant;
    parts.fragments[parts.count++] = part;
  }
  return parts;
}

int quadrant_of(const Fragment& fragment, const glm::ivec2& pixel_px) {
  if (fragment.level == 0) return 0;
  const glm::ivec2 inside = pixel_px - fragment.corner();
  const int half = fragment.side_px() / 2;
  if (inside.y < half) return inside.x < half ? 0 : 1;
  return inside.x < half ? 3 : 2;
}

std::array<std::int32_t, 4> quadrant_pixels(const Fragment& fragment, const FragmentSet& set) {
  std::array<std::int32_t, 4> pixels{kNone, kNone, kNone, kNone};
  const glm::ivec2 last(set.width_px - 1, set.height_px - 1);
  const auto index = [&](const glm::ivec2& at) {
    return static_cast<std::int32_t>(set.pixel(at.x, at.y));
  };
  if (fragment.level == 0) {
    pixels[0] = index(fragment.corner());
    return pixels;
  }
  const int half = fragment.side_px() / 2;
  for (std::size_t quadrant = 0; quadrant < 4; ++quadrant) {
    const glm::ivec2 corner = fragment.corner() + half * kQuadrants[quadrant];
    if (!set.holds(corner)) continue;
    // Left and upper quadrants take the pixel after their centre, the others the one before.
    const glm::ivec2 step = half / 2 - (half > 1 ? kQuadrants[quadrant] : glm::ivec2(0));
    pixels[quadrant] = index(glm::min(corner + step, last));
  }
  return pixels;
}

std::int32_t first_pixel(const Fragment& fragment) {
  const auto found =
      std::ranges::find_if(fragment.pixels, [](std::int32_t pixel) { return pixel != kNone; });
  return found == fragment.pixels.end() ? kNone : *found;
}

glm::vec2 centre_of(const Fragment& fragment, const FragmentSet& set) {
  glm::vec2 sum(0.0F);
  float count = 0.0F;
  for (const std::int32_t pixel : fragment.pixels) {
    if (pixel == kNone) continue;
    sum += glm::vec2(static_cast<float>(pixel % set.width_px) + 0.5F,
                     static_cast<float>(pixel / set.width_px) + 0.5F);
    count += 1.0F;
  }
  return sum / count;
}

void label(const Fragment& fragment, std::int32_t index, FragmentSet& set) {
  const PixelBox box = pixels_of(fragment, set);
  for (int y = box.least.y; y < box.end.y; ++y) {
    const auto row = set.at.begin() + static_cast<std::ptrdiff_t>(set.pixel(0, y));
    std::fill(row + box.least.x, row + box.end.x, index);
  }
}

}  // namespace renderers::area_shadows
