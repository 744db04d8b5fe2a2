#include "renderers/radiosity/radiosity_picture.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/element_hierarchy/camera_surface.h"
#include "renderers/ray_tracing/camera_rays.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::radiosity {

namespace {

using element_hierarchy::CameraSurface;
using element_hierarchy::ShownLight;
using perception::Image;
using ray_tracing::Hit;

constexpr std::size_t kPixelGrain = 256;

void store(Image& image, std::size_t pixel, const glm::vec3& color) {
  std::copy_n(&color.x, 3, image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
}

Image black(const RenderJob& job) {
  return perception::make_rgb_image(job.width_px, job.height_px,
                                    perception::Encoding::scene_linear);
}

Image gray(const RenderJob& job) {
  return perception::make_gray_image(job.width_px, job.height_px, "Y",
                                     perception::Encoding::scene_linear);
}

/// Left edge and top edge of a pixel.
glm::vec2 corner_of(std::size_t pixel, const RenderJob& job) {
  const auto width = static_cast<std::size_t>(job.width_px);
  return {static_cast<float>(pixel % width), static_cast<float>(pixel / width)};
}

/// A saturated colour for a number; neighbours differ.
glm::vec3 color_of(std::uint32_t number) {
  const std::uint64_t hash = ray_tracing::mix_bits(number + 1);
  const auto channel = [&](int shift) {
    return 0.2F + 0.7F * static_cast<float>((hash >> shift) & 255U) / 255.0F;
  };
  return {channel(0), channel(8), channel(16)};
}

class Viewer {
 public:
  Viewer(const ray_tracing::RayScene& rays, const ShownLight* shown,
         const PictureSettings& settings)
      : rays_(rays), shown_(shown), settings_(settings), surface_(rays, shown) {}

  CameraSurface::Light along(const ray_tracing::Ray& ray, const glm::vec4& u) const {
    Hit hit;
    if (!rays_.intersect(ray, hit)) {
      CameraSurface::Light light;
      if (settings_.with_direct) light.direct = surface_.environment(ray.direction);
      return light;
    }
    CameraSurface::Light light = surface_.all(hit, -ray.direction, u);
    if (shown_ != nullptr) {
      const glm::vec3 reflectance =
          ray_tracing::diffuse_albedo(rays_.scene(), hit) / ray_tracing::kPi;
      const ShownLight::Irradiance irradiance = shown_->at(hit, -ray.direction);
      light.direct += reflectance * irradiance.direct;
      light.indirect += reflectance * irradiance.indirect;
    }
    if (!settings_.with_direct) light.direct = glm::vec3(0.0F);
    return light;
  }

 private:
  const ray_tracing::RayScene& rays_;
  const ShownLight* shown_;
  const PictureSettings& settings_;
  CameraSurface surface_;
};

}  // namespace

RadiosityPicture show_solution(const ray_tracing::RayScene& rays, const ShownLight* shown,
                               const RenderJob& job, const PictureSettings& settings) {
  const ray_tracing::CameraRays camera(job.camera, job.width_px, job.height_px);
  const Viewer viewer(rays, shown, settings);
  RadiosityPicture picture{black(job), black(job), 0};
  std::atomic<std::uint64_t> count = 0;
  const auto show_pixel = [&](std::size_t pixel, std::uint64_t& own_rays) {
    const glm::vec2 corner = corner_of(pixel, job);
    const std::uint64_t seed = ray_tracing::hash_combine(settings.seed, pixel);
    CameraSurface::Light sum;
    for (int i = 0; i < settings.camera_rays; ++i) {
      ray_tracing::SampleSequence numbers(ray_tracing::SequenceKind::sobol, seed,
                                          static_cast<std::uint32_t>(i));
      const glm::vec4 u = numbers.next();
      const CameraSurface::Light light =
          viewer.along(camera.through(corner.x + u.x, corner.y + u.y), numbers.next());
      sum.direct += light.direct;
      sum.indirect += light.indirect;
      own_rays += 1 + light.rays;
    }
    const float weight = 1.0F / static_cast<float>(settings.camera_rays);
    store(picture.direct, pixel, weight * sum.direct);
    store(picture.indirect, pixel, weight * sum.indirect);
  };
  base::parallel_for(picture.direct.pixel_count(), kPixelGrain,
                     [&](std::size_t begin, std::size_t end) {
                       std::uint64_t own_rays = 0;
                       for (std::size_t i = begin; i < end; ++i) show_pixel(i, own_rays);
                       count.fetch_add(own_rays, std::memory_order_relaxed);
                     });
  picture.rays = count;
  return picture;
}

std::vector<perception::NamedImage> show_patches(const ray_tracing::RayScene& rays,
                                                 const element_hierarchy::Solution* solution,
                                                 const RenderJob& job) {
  const ray_tracing::CameraRays camera(job.camera, job.width_px, job.height_px);
  Image albedo = black(job);
  Image normal = black(job);
  Image patches = black(job);
  Image links = gray(job);
  const auto show_pixel = [&](std::size_t pixel) {
    const glm::vec2 center = corner_of(pixel, job) + 0.5F;
    const ray_tracing::Ray ray = camera.through(center.x, center.y);
    Hit hit;
    if (!rays.intersect(ray, hit)) return;
    const float side = glm::dot(hit.geometric_normal, ray.direction) < 0.0F ? 1.0F : -1.0F;
    store(albedo, pixel, ray_tracing::diffuse_albedo(rays.scene(), hit));
    store(normal, pixel, side * hit.shading_normal);
    if (solution == nullptr) return;
    const std::uint32_t leaf = solution->tree->leaf_at(hit, -ray.direction);
    if (leaf == element_hierarchy::kNoElement) return;
    store(patches, pixel, color_of(leaf));
    std::size_t count = 0;
    for (std::uint32_t i = leaf; i != element_hierarchy::kNoElement;
         i = solution->tree->at(i).parent) {
      count += solution->links.of(i).size();
    }
    links.pixels[pixel] = static_cast<float>(count);
  };
  base::parallel_for(albedo.pixel_count(), kPixelGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t pixel = begin; pixel < end; ++pixel) show_pixel(pixel);
  });
  std::vector<perception::NamedImage> images;
  images.push_back({"albedo", std::move(albedo)});
  images.push_back({"normal", std::move(normal)});
  images.push_back({"patches", std::move(patches)});
  images.push_back({"patch_links", std::move(links)});
  return images;
}

}  // namespace renderers::radiosity
