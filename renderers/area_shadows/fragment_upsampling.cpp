#include "renderers/area_shadows/fragment_upsampling.h"

#include <algorithm>
#include <utility>

#include <glm/vec4.hpp>

#include "perception/base/parallel.h"

namespace renderers::area_shadows {

namespace {

constexpr std::size_t kRowGrain = 8;
constexpr std::size_t kPixelGrain = 256;

/// Known values of the blocks of one level; the fourth number is 1 where one is known.
struct LevelImage {
  int columns = 0;
  int rows = 0;
  std::vector<glm::vec4> blocks;

  LevelImage(const FragmentSet& set, int level)
      : columns((set.width_px + (1 << level) - 1) >> level),
        rows((set.height_px + (1 << level) - 1) >> level),
        blocks(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows),
               glm::vec4(0.0F)) {}
  glm::vec4& at(int x, int y) {
    return blocks[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(x)];
  }
  const glm::vec4& at(int x, int y) const { return const_cast<LevelImage*>(this)->at(x, y); }
};

/// Bilinear value at the centre of a block of the next finer level, of those known; nothing where
/// the block's own parent is not known.
glm::vec4 upsampled(const LevelImage& coarse, int x, int y) {
  const int own_x = x / 2;
  const int own_y = y / 2;
  if (coarse.at(own_x, own_y).w == 0.0F) return glm::vec4(0.0F);
  // The other parents lie on the side of the parent that the block is on.
  const int beside_x = own_x + (x % 2 == 0 ? -1 : 1);
  const int beside_y = own_y + (y % 2 == 0 ? -1 : 1);
  glm::vec4 sum(0.0F);
  for (const auto& [column, weight_x] : {std::pair(own_x, 0.75F), std::pair(beside_x, 0.25F)}) {
    for (const auto& [row, weight_y] : {std::pair(own_y, 0.75F), std::pair(beside_y, 0.25F)}) {
      if (column < 0 || row < 0 || column >= coarse.columns || row >= coarse.rows) continue;
      sum += weight_x * weight_y * coarse.at(column, row);
    }
  }
  return sum / sum.w;
}

}  // namespace

PixelIrradiance upsample_nearest(const FragmentSet& set, const FragmentLight& light) {
  PixelIrradiance pixels(set.at.size(), glm::vec3(0.0F));
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (set.at[i] == kNone) continue;
    pixels[i] = light.centres[static_cast<std::size_t>(set.at[i])].irradiance;
  }
  return pixels;
}

MultiPass upsample_multi_pass(const FragmentSet& set, const FragmentLight& light,
                              int coarsest_level) {
  std::vector<LevelImage> levels;
  MultiPass result;
  for (int level = 0; level <= coarsest_level; ++level) {
    levels.emplace_back(set, level);
    result.bytes += static_cast<std::int64_t>(levels.back().blocks.size() * sizeof(glm::vec4));
  }
  for (std::size_t i = 0; i < set.fragments.size(); ++i) {
    const Fragment& fragment = set.fragments[i];
    if (fragment.state != Fragment::State::final) continue;
    levels[static_cast<std::size_t>(fragment.level)].at(fragment.x, fragment.y) =
        glm::vec4(light.centres[i].irradiance, 1.0F);
  }
  for (int level = coarsest_level - 1; level >= 0; --level) {
    LevelImage& fine = levels[static_cast<std::size_t>(level)];
    const LevelImage& coarse = levels[static_cast<std::size_t>(level) + 1];
    base::parallel_for(static_cast<std::size_t>(fine.rows), kRowGrain,
                       [&](std::size_t begin, std::size_t end) {
                         for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
                           for (int x = 0; x < fine.columns; ++x) {
                             if (fine.at(x, y).w == 0.0F) fine.at(x, y) = upsampled(coarse, x, y);
                           }
                         }
                       });
  }
  for (const glm::vec4& block : levels[0].blocks) result.irradiance.emplace_back(block);
  return result;
}

void take_visible_share(FragmentLight& light) {
  const auto take = [](LightSample& sample) {
    for (int c = 0; c < 3; ++c) {
      float& value = sample.irradiance[c];
      value = sample.open[c] > 0.0F ? value / sample.open[c] : 0.0F;
    }
  };
  std::ranges::for_each(light.centres, take);
  std::ranges::for_each(light.extras, take);
}

void restore_irradiance(const ShadowTracer& tracer, const FragmentSet& set,
                        const FragmentLight& light, PixelIrradiance& shares) {
  base::parallel_for(shares.size(), kPixelGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      if (set.at[pixel] == kNone || !tracer.surfaces().pixels[pixel].is_surface()) continue;
      const auto index = static_cast<std::size_t>(set.at[pixel]);
      if (set.fragments[index].level == 0) {
        shares[pixel] = light.centres[index].irradiance;
      } else if (shares[pixel] != glm::vec3(0.0F)) {
        shares[pixel] *= tracer.open_light_of(pixel);
      }
    }
  });
}

}  // namespace renderers::area_shadows
