#include "renderers/area_shadows/shadow_tracer.h"

#include <bit>
#include <cassert>

namespace renderers::area_shadows {

using ray_tracing::group_factors;
using ray_tracing::group_irradiance;
using ray_tracing::GroupFactors;
using ray_tracing::LightPointSet;
using ray_tracing::may_shine_on;
using ray_tracing::Receiver;

ShadowTracer::ShadowTracer(const ray_tracing::RayScene& rays, const PixelSurfaces& surfaces,
                           const std::vector<LightPointSet>& lights)
    : rays_(rays), surfaces_(surfaces), lights_(lights) {
  for (const LightPointSet& light : lights) groups_ = std::max(groups_, light.group_count());
  assert(groups_ <= kMostGroups);
  traced_.resize(surfaces.pixels.size() * lights.size());
  bits_.resize(traced_.size() * groups_);
  facing_.resize(bits_.size());
}

std::uint32_t ShadowTracer::visible(std::size_t pixel, std::size_t light, std::size_t group,
                                    std::uint64_t& rays) {
  const std::size_t index = pixel * lights_.size() + light;
  std::uint16_t& bits = bits_[index * groups_ + group];
  if (is_known(pixel, light, group)) return bits;
  traced_[index] = static_cast<std::uint16_t>(traced_[index] | (1U << group));
  const Receiver& receiver = surfaces_.pixels[pixel].receiver;
  if (!may_shine_on(lights_[light], receiver)) return bits;
  const std::uint32_t facing = group_factors(lights_[light], group, receiver).facing;
  rays += static_cast<std::uint64_t>(std::popcount(facing));
  facing_[index * groups_ + group] = static_cast<std::uint16_t>(facing);
  bits = static_cast<std::uint16_t>(
      ray_tracing::visible_points(rays_, lights_[light], group, receiver, facing));
  return bits;
}

PixelLight ShadowTracer::light_of(std::size_t pixel, std::uint64_t& rays) {
  PixelLight sum;
  const Receiver& receiver = surfaces_.pixels[pixel].receiver;
  for (std::size_t light = 0; light < lights_.size(); ++light) {
    if (!may_shine_on(lights_[light], receiver)) continue;
    for (std::size_t group = 0; group < lights_[light].group_count(); ++group) {
      const std::uint32_t bits = visible(pixel, light, group, rays);
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

std::uint32_t ShadowTracer::lit_points(std::size_t pixel) const {
  std::uint32_t count = 0;
  const std::size_t per_pixel = lights_.size() * groups_;
  for (std::size_t i = pixel * per_pixel; i < (pixel + 1) * per_pixel; ++i) {
    count += static_cast<std::uint32_t>(std::popcount(bits_[i]));
  }
  return count;
}

std::int64_t ShadowTracer::memory_bytes() const {
  return static_cast<std::int64_t>((bits_.size() + facing_.size() + traced_.size()) *
                                   sizeof(std::uint16_t));
}

glm::vec3 open_irradiance(std::span<const LightPointSet> lights, const Receiver& receiver) {
  glm::vec3 sum(0.0F);
  for (const LightPointSet& light : lights) {
    if (!may_shine_on(light, receiver)) continue;
    for (std::size_t group = 0; group < light.group_count(); ++group) {
      const GroupFactors factors = group_factors(light, group, receiver);
      sum += group_irradiance(light, group, factors, factors.facing);
    }
  }
  return sum;
}

}  // namespace renderers::area_shadows
