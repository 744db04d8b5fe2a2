#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include <glm/vec2.hpp>

#include "perception/base/parallel.h"
#include "renderers/ray_tracing/ray_scene.h"

namespace renderers::ray_tracing {

/// Pixels of a square, whose camera rays are a packet; fewer at the right and lower edge.
struct PixelTile {
  static constexpr int kSide_px = 4;
  static_assert(kSide_px * kSide_px == kPacketRays);

  std::array<glm::ivec2, kPacketRays> pixels{};  ///< row by row
  std::size_t count = 0;
};

/// Hands over all tiles of a picture, each once, from any thread.
/// @param look  takes a const PixelTile&
template <typename Look>
void for_each_tile(int width_px, int height_px, const Look& look) {
  constexpr std::size_t kRowGrain = 2;
  constexpr int kSide_px = PixelTile::kSide_px;
  const auto rows = static_cast<std::size_t>((height_px + kSide_px - 1) / kSide_px);
  base::parallel_for(rows, kRowGrain, [&](std::size_t begin, std::size_t end) {
    for (auto row = static_cast<int>(begin); row < static_cast<int>(end); ++row) {
      const int top = row * kSide_px;
      for (int left = 0; left < width_px; left += kSide_px) {
        PixelTile tile;
        for (int y = top; y < std::min(top + kSide_px, height_px); ++y) {
          for (int x = left; x < std::min(left + kSide_px, width_px); ++x) {
            tile.pixels[tile.count++] = {x, y};
          }
        }
        look(tile);
      }
    }
  });
}

}  // namespace renderers::ray_tracing
