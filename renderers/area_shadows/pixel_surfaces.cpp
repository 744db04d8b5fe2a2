#include "renderers/area_shadows/pixel_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "renderers/ray_tracing/camera_rays.h"
#include "renderers/ray_tracing/light_sampler.h"
#include "renderers/ray_tracing/pixel_tiles.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::area_shadows {

namespace {

glm::mat3 eye_axes(const scene::Camera& camera) {
  const glm::vec3 forward = glm::normalize(camera.look_at - camera.position);
  const glm::vec3 right = glm::normalize(glm::cross(forward, camera.up));
  return glm::transpose(glm::mat3(right, glm::cross(right, forward), -forward));
}

PixelSurface surface_of(const scene::Scene& scene, const ray_tracing::Hit& hit,
                        const glm::vec3& camera) {
  PixelSurface surface;
  surface.receiver = ray_tracing::receiver_at(hit, camera);
  surface.albedo = ray_tracing::diffuse_albedo(scene, hit);
  surface.depth_m = hit.t;
  surface.material = hit.material;
  surface.is_glossy = scene.materials[static_cast<std::size_t>(hit.material)].is_glossy();
  return surface;
}

/// Looks through the pixels of one tile at a time, whose rays are a packet.
class SurfaceFinder {
 public:
  SurfaceFinder(const ray_tracing::RayScene& rays, const RenderJob& job, PixelSurfaces& surfaces)
      : rays_(rays),
        camera_(job.camera, job.width_px, job.height_px),
        lights_(rays, ray_tracing::LightSet::hittable),
        surfaces_(surfaces) {}

  void look(const ray_tracing::PixelTile& tile) const {
    std::array<ray_tracing::Ray, ray_tracing::kPacketRays> packet;
    for (std::size_t i = 0; i < tile.count; ++i) {
      const glm::vec2 middle = glm::vec2(tile.pixels[i]) + 0.5F;
      packet[i] = camera_.through(middle.x, middle.y);
    }
    std::array<ray_tracing::LineHit, ray_tracing::kPacketRays> hits;
    const std::uint32_t found = rays_.nearest(std::span(packet).first(tile.count), hits);
    for (std::size_t i = 0; i < tile.count; ++i) {
      const bool is_hit = ((found >> i) & 1U) != 0;
      store(packet[i].direction, is_hit ? &hits[i] : nullptr,
            surfaces_.index(tile.pixels[i].x, tile.pixels[i].y));
    }
  }

 private:
  /// @param found  null: the ray left the scene
  void store(const glm::vec3& direction, const ray_tracing::LineHit* found,
             std::size_t pixel) const {
    glm::vec3 seen(0.0F);
    if (found != nullptr) {
      const ray_tracing::Hit hit = rays_.hit_at(*found);
      surfaces_.pixels[pixel] = surface_of(rays_.scene(), hit, surfaces_.camera);
      seen = lights_.emission(hit, -direction);
    } else {
      seen = lights_.environment(direction);
    }
    std::copy_n(&seen.x, 3, surfaces_.seen.pixels.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
  }

  const ray_tracing::RayScene& rays_;
  ray_tracing::CameraRays camera_;
  ray_tracing::LightSampler lights_;
  PixelSurfaces& surfaces_;
};

}  // namespace

PixelSurfaces find_pixel_surfaces(const ray_tracing::RayScene& rays, const RenderJob& job) {
  PixelSurfaces surfaces;
  surfaces.width_px = job.width_px;
  surfaces.height_px = job.height_px;
  surfaces.camera = job.camera.position;
  surfaces.to_eye = eye_axes(job.camera);
  surfaces.seen =
      perception::make_rgb_image(job.width_px, job.height_px, perception::Encoding::scene_linear);
  surfaces.pixels.resize(surfaces.seen.pixel_count());
  const SurfaceFinder finder(rays, job, surfaces);
  ray_tracing::for_each_tile(job.width_px, job.height_px,
                             [&](const ray_tracing::PixelTile& tile) { finder.look(tile); });
  return surfaces;
}

bool is_same_surface(const PixelSurface& a, const PixelSurface& b,
                     const SurfaceTolerance& tolerance) {
  if (!a.is_surface() || !b.is_surface()) return false;
  const glm::vec3& normal_a = a.receiver.normal;
  const glm::vec3& normal_b = b.receiver.normal;
  if (1.0F - glm::dot(normal_a, normal_b) > tolerance.normal) return false;
  const glm::vec3 between = b.receiver.position - a.receiver.position;
  const float distance_m = std::fabs(0.5F * glm::dot(normal_a + normal_b, between));
  return distance_m <= tolerance.plane * a.depth_m;
}

}  // namespace renderers::area_shadows
