#include "renderers/area_shadows/pixel_surfaces.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "perception/base/parallel.h"
#include "renderers/ray_tracing/camera_rays.h"
#include "renderers/ray_tracing/light_sampler.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::area_shadows {

namespace {

constexpr std::size_t kPixelGrain = 1024;

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
  const ray_tracing::CameraRays camera(job.camera, job.width_px, job.height_px);
  const ray_tracing::LightSampler lights(rays, ray_tracing::LightSet::hittable);
  const auto look = [&](std::size_t pixel) {
    const auto width = static_cast<std::size_t>(job.width_px);
    const ray_tracing::Ray ray = camera.through(static_cast<float>(pixel % width) + 0.5F,
                                                static_cast<float>(pixel / width) + 0.5F);
    glm::vec3 seen(0.0F);
    ray_tracing::Hit hit;
    if (rays.intersect(ray, hit)) {
      surfaces.pixels[pixel] = surface_of(rays.scene(), hit, job.camera.position);
      seen = lights.emission(hit, -ray.direction);
    } else {
      seen = lights.environment(ray.direction);
    }
    std::copy_n(&seen.x, 3, surfaces.seen.pixels.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
  };
  base::parallel_for(surfaces.pixels.size(), kPixelGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t pixel = begin; pixel < end; ++pixel) look(pixel);
  });
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
