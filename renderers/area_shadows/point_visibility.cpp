#include "renderers/area_shadows/point_visibility.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "perception/base/parallel.h"

namespace renderers::area_shadows {

using ray_tracing::LightPointSet;

namespace {

constexpr std::size_t kGroupGrain = 256;
/// Groups of the pixels that a thread takes at a time.
constexpr std::size_t kGroupsOfPixels = 4096;

}  // namespace

void EmbreeVisibility::find(std::span<const GroupRays> rays, std::span<std::uint16_t> visible,
                            StageTimer& timer) {
  assert(rays.size() == visible.size());
  const auto stage = timer.stage("rays");
  base::parallel_for(rays.size(), kGroupGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const GroupRays& group = rays[i];
      visible[i] = static_cast<std::uint16_t>(
          ray_tracing::visible_points(rays_, lights_[group.light], group.group,
                                      surfaces_.pixels[group.pixel].receiver, group.facing));
    }
  });
}

GroupRays rays_to_group(const PixelSurfaces& surfaces, const std::vector<LightPointSet>& lights,
                        std::uint32_t pixel, std::size_t light, std::size_t group) {
  GroupRays rays{pixel, static_cast<std::uint32_t>(light), static_cast<std::uint16_t>(group), 0};
  find_facing(surfaces, lights, std::span(&rays, 1));
  return rays;
}

void find_facing(const PixelSurfaces& surfaces, const std::vector<LightPointSet>& lights,
                 std::span<GroupRays> rays, std::span<ray_tracing::GroupFactors> factors) {
  assert(factors.empty() || factors.size() == rays.size());
  const GroupRays* before = nullptr;
  bool may_shine = false;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    GroupRays& group = rays[i];
    const ray_tracing::Receiver& receiver = surfaces.pixels[group.pixel].receiver;
    const LightPointSet& light = lights[group.light];
    const bool is_same =
        before != nullptr && before->pixel == group.pixel && before->light == group.light;
    if (!is_same) may_shine = may_shine_on(light, receiver);
    before = &group;
    group.facing = 0;
    if (!may_shine) continue;
    const ray_tracing::GroupFactors of_group = group_factors(light, group.group, receiver);
    group.facing = static_cast<std::uint16_t>(of_group.facing);
    if (!factors.empty()) factors[i] = of_group;
  }
}

[[gnu::target_clones("popcnt", "default")]] std::uint64_t count_rays(
    std::span<const GroupRays> rays) {
  std::uint64_t count = 0;
  for (const GroupRays& group : rays) {
    count += static_cast<std::uint64_t>(std::popcount(group.facing));
  }
  return count;
}

RayCounts visit_pixels(PointVisibility& visibility, const LitPixels& lit, StageTimer& timer,
                       const std::function<void(const PixelPoints&)>& body) {
  std::size_t per_pixel = 0;
  for (const LightPointSet& light : lit.lights) per_pixel += light.group_count();
  const std::size_t at_once =
      std::max<std::size_t>(1, kMostListedGroups / std::max<std::size_t>(1, per_pixel));
  const std::size_t grain =
      std::max<std::size_t>(1, kGroupsOfPixels / std::max<std::size_t>(1, per_pixel));
  std::vector<GroupRays> groups;
  std::vector<ray_tracing::GroupFactors> factors;
  std::vector<std::uint16_t> visible;
  RayCounts counts;
  for (std::size_t first = 0; first < lit.pixels.size(); first += at_once) {
    const auto pixels = lit.pixels.subspan(first, std::min(at_once, lit.pixels.size() - first));
    groups.resize(pixels.size() * per_pixel);
    visible.resize(groups.size());
    factors.resize(groups.size());
    base::parallel_for(pixels.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        std::size_t at = i * per_pixel;
        for (std::size_t light = 0; light < lit.lights.size(); ++light) {
          for (std::size_t group = 0; group < lit.lights[light].group_count(); ++group) {
            groups[at++] = {pixels[i], static_cast<std::uint32_t>(light),
                            static_cast<std::uint16_t>(group), 0};
          }
        }
      }
      find_facing(lit.surfaces, lit.lights,
                  std::span(groups).subspan(begin * per_pixel, (end - begin) * per_pixel),
                  std::span(factors).subspan(begin * per_pixel, (end - begin) * per_pixel));
    });
    counts.rays += count_rays(groups);
    visibility.find(groups, visible, timer);
    for (const std::uint16_t bits : visible) {
      counts.unhidden += static_cast<std::uint64_t>(std::popcount(bits));
    }
    base::parallel_for(pixels.size(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        body({pixels[i], std::span(groups).subspan(i * per_pixel, per_pixel),
              std::span(visible).subspan(i * per_pixel, per_pixel),
              std::span(factors).subspan(i * per_pixel, per_pixel)});
      }
    });
  }
  return counts;
}

std::vector<std::uint32_t> surface_pixels(const PixelSurfaces& surfaces) {
  std::vector<std::uint32_t> pixels;
  for (std::size_t pixel = 0; pixel < surfaces.pixels.size(); ++pixel) {
    if (surfaces.pixels[pixel].is_surface()) pixels.push_back(static_cast<std::uint32_t>(pixel));
  }
  return pixels;
}

}  // namespace renderers::area_shadows
