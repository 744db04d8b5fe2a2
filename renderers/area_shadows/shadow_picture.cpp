#include "renderers/area_shadows/shadow_picture.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::area_shadows {

namespace {

using ray_tracing::LightPoint;
using ray_tracing::LightPointSet;
using ray_tracing::Receiver;
using ray_tracing::SurfaceBrdf;

constexpr std::size_t kPixelGrain = 256;

perception::Image black_picture(const PixelSurfaces& surfaces) {
  return perception::make_rgb_image(surfaces.width_px, surfaces.height_px,
                                    perception::Encoding::scene_linear);
}

void store(const glm::vec3& value, std::size_t pixel, OtherLight& light) {
  std::copy_n(&value.x, 3, light.radiance.pixels.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
}

/// Calls light_of(pixel, rays) for every pixel with a surface and stores what it returns.
template <typename LightOf>
OtherLight light_pixels(const PixelSurfaces& surfaces, const LightOf& light_of) {
  OtherLight light;
  light.radiance = black_picture(surfaces);
  std::atomic<std::uint64_t> rays = 0;
  base::parallel_for(surfaces.pixels.size(), kPixelGrain, [&](std::size_t begin, std::size_t end) {
    std::uint64_t own_rays = 0;
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      if (!surfaces.pixels[pixel].is_surface()) continue;
      store(light_of(surfaces.pixels[pixel], own_rays), pixel, light);
    }
    rays.fetch_add(own_rays, std::memory_order_relaxed);
  });
  light.rays = rays;
  return light;
}

SurfaceBrdf brdf_of(const scene::Scene& scene, const PixelSurface& surface,
                    const glm::vec3& camera) {
  SurfaceBrdf brdf;
  brdf.geometric_normal = surface.receiver.geometric_normal;
  brdf.normal = surface.receiver.normal;
  brdf.diffuse = surface.albedo;
  if (surface.is_glossy) {
    ray_tracing::add_glossy_lobe(scene.materials[static_cast<std::size_t>(surface.material)],
                                 glm::normalize(camera - surface.receiver.position), brdf);
  }
  return brdf;
}

glm::vec3 light_of_points(const ray_tracing::RayScene& rays, const Receiver& receiver,
                          const SurfaceBrdf& brdf, std::uint64_t& rays_cast) {
  glm::vec3 sum(0.0F);
  for (const scene::Light& light : rays.scene().lights) {
    const glm::vec3 to_light = light.position - receiver.position;
    const float d2 = glm::dot(to_light, to_light);
    if (d2 <= 0.0F) continue;
    const glm::vec3 direction = to_light / std::sqrt(d2);
    const glm::vec3 reflected =
        evaluate(brdf, direction) * scene::intensity_towards(light, -direction) / d2;
    if (reflected == glm::vec3(0.0F)) continue;
    ++rays_cast;
    const ray_tracing::Ray ray{receiver.origin, light.position - receiver.origin,
                               ray_tracing::kSegmentEnd};
    if (!rays.is_occluded(ray)) sum += reflected;
  }
  return sum;
}

/// Points of a group that a pixel sees, and their factors.
struct VisiblePoints {
  const LightPointSet& light;
  std::size_t group = 0;
  const ray_tracing::GroupFactors& factors;
  std::uint32_t visible = 0;
};

/// The lobe's light from those points; factors hold the receiver's cosine.
glm::vec3 lobe_light(const VisiblePoints& seen, const Receiver& receiver, const SurfaceBrdf& lobe) {
  const auto& [light, group, factors, visible] = seen;
  const auto points = light.group(group);
  glm::vec3 sum(0.0F);
  for (std::uint32_t left = visible; left != 0; left &= left - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(left));
    const LightPoint& point = points[k];
    const glm::vec3 direction =
        light.is_environment ? point.position : glm::normalize(point.position - receiver.position);
    const float cosine = glm::dot(receiver.normal, direction);
    sum += evaluate(lobe, direction) * point.power * (factors.values[k] / cosine);
  }
  return sum;
}

}  // namespace

OtherLight add_point_lights(const ray_tracing::RayScene& rays, const PixelSurfaces& surfaces) {
  return light_pixels(surfaces, [&](const PixelSurface& surface, std::uint64_t& rays_cast) {
    const SurfaceBrdf brdf = brdf_of(rays.scene(), surface, surfaces.camera);
    return light_of_points(rays, surface.receiver, brdf, rays_cast);
  });
}

OtherLight add_glossy_lobes(const scene::Scene& scene, const PixelSurfaces& surfaces,
                            const std::vector<LightPointSet>& lights, PointVisibility& visibility,
                            StageTimer& timer) {
  OtherLight light;
  light.radiance = black_picture(surfaces);
  std::vector<std::uint32_t> pixels = surface_pixels(surfaces);
  std::erase_if(pixels, [&](std::uint32_t pixel) { return !surfaces.pixels[pixel].is_glossy; });
  const auto add = [&](const PixelPoints& points) {
    const PixelSurface& surface = surfaces.pixels[points.pixel];
    SurfaceBrdf lobe = brdf_of(scene, surface, surfaces.camera);
    lobe.diffuse = glm::vec3(0.0F);
    glm::vec3 sum(0.0F);
    for (std::size_t i = 0; i < points.groups.size(); ++i) {
      if (points.visible[i] == 0) continue;
      const GroupRays& at = points.groups[i];
      sum += lobe_light({lights[at.light], at.group, points.factors[i], points.visible[i]},
                        surface.receiver, lobe);
    }
    store(sum, points.pixel, light);
  };
  light.rays = visit_pixels(visibility, {surfaces, lights, pixels}, timer, add).rays;
  return light;
}

perception::Image compose(const PixelSurfaces& surfaces, const std::vector<glm::vec3>& irradiance,
                          const std::vector<const OtherLight*>& others) {
  perception::Image radiance = surfaces.seen;
  for (std::size_t pixel = 0; pixel < surfaces.pixels.size(); ++pixel) {
    const glm::vec3 reflected =
        irradiance[pixel] * surfaces.pixels[pixel].albedo * (1.0F / ray_tracing::kPi);
    for (std::size_t c = 0; c < 3; ++c) {
      float& value = radiance.pixels[3 * pixel + c];
      value += reflected[static_cast<int>(c)];
      for (const OtherLight* other : others) value += other->radiance.pixels[3 * pixel + c];
    }
  }
  return radiance;
}

perception::Image image_of(const PixelSurfaces& surfaces, const std::vector<glm::vec3>& values) {
  perception::Image image = perception::make_rgb_image(surfaces.width_px, surfaces.height_px,
                                                       perception::Encoding::scene_linear);
  for (std::size_t pixel = 0; pixel < values.size(); ++pixel) {
    std::copy_n(&values[pixel].x, 3, image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
  }
  return image;
}

}  // namespace renderers::area_shadows
