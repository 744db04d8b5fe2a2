#include "renderers/ray_bundles/atlas_lights.h"

#include <atomic>
#include <optional>

#include "perception/base/parallel.h"
#include "renderers/ray_tracing/light_sampler.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::ray_bundles {

namespace {

using ray_tracing::LightSample;
using ray_tracing::SurfaceBrdf;
using texel_atlas::Side;

/// Lambert of albedo 1: what it reflects is J.
SurfaceBrdf white_side(const ray_tracing::SurfacePoint& point, Side side) {
  const float sign = side == Side::front ? 1.0F : -1.0F;
  SurfaceBrdf brdf;
  brdf.geometric_normal = sign * point.geometric_normal;
  brdf.normal = sign * point.shading_normal;
  brdf.diffuse = glm::vec3(1.0F);
  return brdf;
}

class SideLight {
 public:
  SideLight(const ray_tracing::RayScene& rays, const AtlasLightSettings& settings)
      : rays_(rays), settings_(settings), areas_(rays, ray_tracing::LightSet::hittable) {}

  glm::vec3 incident(const texel_atlas::Texel& texel, Side side, std::uint64_t seed,
                     std::uint64_t& shadow_rays) const {
    const SurfaceBrdf brdf = white_side(texel.point, side);
    glm::vec3 sum(0.0F);
    for (const scene::Light& light : rays_.scene().lights) {
      sum += arriving(areas_.sample_point_light(light, texel.point), brdf, shadow_rays);
    }
    if (settings_.soft != nullptr) return sum + settings_.soft->reflected(texel.point, brdf);
    if (!settings_.with_areas || areas_.is_empty()) return sum;
    glm::vec3 areas(0.0F);
    for (int i = 0; i < settings_.light_samples; ++i) {
      ray_tracing::SampleSequence numbers(ray_tracing::SequenceKind::sobol, seed,
                                          static_cast<std::uint32_t>(i));
      areas += arriving(areas_.sample(texel.point, glm::vec3(numbers.next())), brdf, shadow_rays);
    }
    return sum + areas / static_cast<float>(settings_.light_samples);
  }

 private:
  glm::vec3 arriving(const std::optional<LightSample>& light, const SurfaceBrdf& brdf,
                     std::uint64_t& shadow_rays) const {
    if (!light) return glm::vec3(0.0F);
    const glm::vec3 value = evaluate(brdf, light->direction) * light->radiance;
    if (value == glm::vec3(0.0F)) return value;
    ++shadow_rays;
    return rays_.is_occluded(light->shadow_ray) ? glm::vec3(0.0F) : value / light->pdf;
  }

  const ray_tracing::RayScene& rays_;
  const AtlasLightSettings& settings_;
  ray_tracing::LightSampler areas_;
};

}  // namespace

AtlasLight light_atlas(const ray_tracing::RayScene& rays, const texel_atlas::TexelAtlas& atlas,
                       const AtlasLightSettings& settings) {
  constexpr std::size_t kGrain = 1024;
  const SideLight lights(rays, settings);
  AtlasLight result;
  result.incident.resize(2 * atlas.texels().size());
  std::atomic<std::uint64_t> shadow_rays = 0;
  base::parallel_for(atlas.texels().size(), kGrain, [&](std::size_t begin, std::size_t end) {
    std::uint64_t own_rays = 0;
    for (std::size_t i = begin; i < end; ++i) {
      for (const Side side : {Side::front, Side::back}) {
        if (side == Side::back && !settings.has_back_sides) continue;
        const std::uint32_t index = texel_atlas::side_index(static_cast<std::uint32_t>(i), side);
        result.incident[index] = lights.incident(
            atlas.texels()[i], side, ray_tracing::hash_combine(settings.seed, index), own_rays);
      }
    }
    shadow_rays.fetch_add(own_rays, std::memory_order_relaxed);
  });
  result.shadow_rays = shadow_rays;
  return result;
}

}  // namespace renderers::ray_bundles
