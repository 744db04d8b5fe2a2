#include "renderers/area_shadows/shadow_tracer.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <utility>

#include "perception/base/parallel.h"

namespace renderers::area_shadows {

using ray_tracing::facing_points;
using ray_tracing::group_factors;
using ray_tracing::group_irradiance;
using ray_tracing::GroupFactors;
using ray_tracing::LightPointSet;
using ray_tracing::may_shine_on;
using ray_tracing::Receiver;

namespace {

constexpr std::size_t kGroupGrain = 256;
constexpr std::size_t kPixelGrain = 4096;
constexpr std::uint16_t kAllGroups = 0xFFFF;

}  // namespace

ShadowTracer::ShadowTracer(PointVisibility& visibility, const PixelSurfaces& surfaces,
                           const std::vector<LightPointSet>& lights, StageTimer& timer)
    : visibility_(visibility), surfaces_(surfaces), lights_(lights), timer_(timer) {
  for (const LightPointSet& light : lights) groups_ = std::max(groups_, light.group_count());
  assert(groups_ <= kMostGroups);
  traced_.resize(surfaces.pixels.size() * lights.size());
  bits_.resize(traced_.size() * groups_);
  may_be_lit_.resize(surfaces.pixels.size());
  find_lights_below();
}

/// Asks once for each pixel, in their order, what is needed for each of them several times.
void ShadowTracer::find_lights_below() {
  base::parallel_for(may_be_lit_.size(), kPixelGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      const PixelSurface& surface = surfaces_.pixels[pixel];
      if (!surface.is_surface()) continue;
      for (std::size_t light = 0; light < lights_.size(); ++light) {
        if (may_shine_on(lights_[light], surface.receiver)) {
          may_be_lit_[pixel] = 1;
        } else {
          traced_[pixel * lights_.size() + light] = kAllGroups;
        }
      }
    }
  });
}

void ShadowTracer::ask(const PointGroup& group) {
  if (is_known(group.pixel, group.light, group.group)) return;
  std::uint16_t& traced = traced_[group.pixel * lights_.size() + group.light];
  traced = static_cast<std::uint16_t>(traced | (1U << group.group));
  unknown_.push_back({group.pixel, group.light, group.group, 0});
  if (unknown_.size() >= kMostListedGroups) trace_unknown();
}

void ShadowTracer::ask_pixel(std::uint32_t pixel) {
  for (std::uint32_t light = 0; light < lights_.size(); ++light) {
    for (std::uint16_t group = 0; group < lights_[light].group_count(); ++group) {
      ask({pixel, light, group});
    }
  }
}

std::uint64_t ShadowTracer::trace() {
  trace_unknown();
  return std::exchange(rays_, 0);
}

std::uint64_t ShadowTracer::trace_pixels(std::span<const std::uint32_t> pixels) {
  for (const std::uint32_t pixel : pixels) ask_pixel(pixel);
  return trace();
}

void ShadowTracer::trace_unknown() {
  if (unknown_.empty()) return;
  const std::span<GroupRays> rays(unknown_);
  base::parallel_for(rays.size(), kGroupGrain, [&](std::size_t begin, std::size_t end) {
    for (GroupRays& group : rays.subspan(begin, end - begin)) {
      const Receiver& receiver = surfaces_.pixels[group.pixel].receiver;
      group.facing =
          static_cast<std::uint16_t>(facing_points(lights_[group.light], group.group, receiver));
    }
  });
  visible_.resize(rays.size());
  visibility_.find(rays, visible_, timer_);
  rays_ += count_rays(rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const GroupRays& group = rays[i];
    const std::size_t at = (group.pixel * lights_.size() + group.light) * groups_ + group.group;
    bits_[at] = {visible_[i], group.facing};
  }
  unknown_.clear();
}

PixelLight ShadowTracer::light_of(std::size_t pixel) const {
  PixelLight sum;
  const Receiver& receiver = surfaces_.pixels[pixel].receiver;
  for (std::size_t light = 0; light < lights_.size(); ++light) {
    for (std::size_t group = 0; group < lights_[light].group_count(); ++group) {
      assert(is_known(pixel, light, group));
      if (facing(pixel, light, group) == 0) continue;
      const std::uint32_t bits = known(pixel, light, group);
      const GroupFactors factors = group_factors(lights_[light], group, receiver);
      const glm::vec3 open = group_irradiance(lights_[light], group, factors, factors.facing);
      sum.open += open;
      if (bits == factors.facing) {
        sum.irradiance += open;
      } else if (bits != 0) {
        sum.irradiance += group_irradiance(lights_[light], group, factors, bits);
      }
    }
  }
  return sum;
}

glm::vec3 ShadowTracer::open_light_of(std::size_t pixel) const {
  if (!may_be_lit(pixel)) return glm::vec3(0.0F);
  return open_irradiance(lights_, surfaces_.pixels[pixel].receiver);
}

std::uint32_t ShadowTracer::lit_points(std::size_t pixel) const {
  std::uint32_t count = 0;
  const std::size_t per_pixel = lights_.size() * groups_;
  for (std::size_t i = pixel * per_pixel; i < (pixel + 1) * per_pixel; ++i) {
    count += static_cast<std::uint32_t>(std::popcount(bits_[i].seen));
  }
  return count;
}

std::int64_t ShadowTracer::memory_bytes() const {
  return static_cast<std::int64_t>(bits_.size() * sizeof(GroupBits) +
                                   traced_.size() * sizeof(std::uint16_t) + may_be_lit_.size());
}

std::int64_t ShadowTracer::list_bytes() const {
  return static_cast<std::int64_t>(unknown_.capacity() * sizeof(GroupRays) +
                                   visible_.capacity() * sizeof(std::uint16_t));
}

glm::vec3 open_irradiance(std::span<const LightPointSet> lights, const Receiver& receiver) {
  glm::vec3 sum(0.0F);
  for (const LightPointSet& light : lights) {
    if (may_shine_on(light, receiver)) sum += ray_tracing::open_irradiance(light, receiver);
  }
  return sum;
}

}  // namespace renderers::area_shadows
