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
  // Few enough that threads share a small picture, too.
  constexpr std::size_t kTileGrain = 16;
  constexpr int kSide_px = PixelTile::kSide_px;
  const auto columns = static_cast<std::size_t>((width_px + kSide_px - 1) / kSide_px);
  const auto rows = static_cast<std::size_t>((height_px + kSide_px - 1) / kSide_px);
  base::parallel_for(columns * rows, kTileGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t at = begin; at < end; ++at) {
      const int left = static_cast<int>(at % columns) * kSide_px;
      const int top = static_cast<int>(at / columns) * kSide_px;
      PixelTile tile;
      for (int y = top; y < std::min(top + kSide_px, height_px); ++y) {
        for (int x = left; x < std::min(left + kSide_px, width_px); ++x) {
          tile.pixels[tile.count++] = {x, y};
        }
      }
      look(tile);
    }
  });
}

}  // namespace renderers::ray_tracing
