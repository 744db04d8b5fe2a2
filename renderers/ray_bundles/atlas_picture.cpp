#include "renderers/ray_bundles/atlas_picture.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>
#include <span>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/ray_tracing/camera_rays.h"
#include "renderers/ray_tracing/pixel_tiles.h"
#include "renderers/ray_tracing/point_light_shading.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::ray_bundles {

namespace {

using perception::Image;
using ray_tracing::Hit;
using texel_atlas::Side;

constexpr std::size_t kPixelGrain = 256;

Side seen_side(const Hit& hit, const glm::vec3& direction) {
  return glm::dot(hit.geometric_normal, direction) < 0.0F ? Side::front : Side::back;
}

void store(Image& image, std::size_t pixel, const glm::vec3& color) {
  std::copy_n(&color.x, 3, image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
}

Image black(const RenderJob& job) {
  return perception::make_rgb_image(job.width_px, job.height_px,
                                    perception::Encoding::scene_linear);
}

/// A saturated colour for a number; neighbours differ.
glm::vec3 color_of(std::uint32_t number) {
  const std::uint64_t hash = ray_tracing::mix_bits(number + 1);
  const auto channel = [&](int shift) {
    return 0.2F + 0.7F * static_cast<float>((hash >> shift) & 255U) / 255.0F;
  };
  return {channel(0), channel(8), channel(16)};
}

class AtlasViewer {
 public:
  AtlasViewer(const ray_tracing::RayScene& rays, const texel_atlas::TexelAtlas& atlas,
              const LightSolution& solution, const PictureSettings& settings)
      : rays_(rays), settings_(settings), solution_(solution), lookup_(atlas), lights_(rays) {}

  struct Light {
    glm::vec3 direct{0.0F};
    glm::vec3 indirect{0.0F};
  };
  /// Of a ray that leaves the scene. @param direction  of the look
  Light outside(const glm::vec3& direction) const;
  /// Of a ray that meets a surface.
  /// @param numbers  of the ray, for its reflection
  /// @param rays     counts the further ones
  Light at(const Hit& hit, const glm::vec3& direction, ray_tracing::SampleSequence& numbers,
           std::uint64_t& rays) const;

 private:
  void add_glossy(const Hit& hit, const glm::vec3& to_viewer, const glm::vec4& u, Light& light,
                  std::uint64_t& rays) const;
  glm::vec3 leaving(const Hit& hit, const glm::vec3& direction) const;

  const ray_tracing::RayScene& rays_;
  const PictureSettings& settings_;
  const LightSolution& solution_;
  AtlasLookup lookup_;
  ray_tracing::LightSampler lights_;
};

AtlasViewer::Light AtlasViewer::outside(const glm::vec3& direction) const {
  Light light;
  if (settings_.with_emission) light.direct = lights_.environment(direction);
  return light;
}

AtlasViewer::Light AtlasViewer::at(const Hit& hit, const glm::vec3& direction,
                                   ray_tracing::SampleSequence& numbers,
                                   std::uint64_t& rays) const {
  Light light;
  if (settings_.with_emission) light.direct = lights_.emission(hit, -direction);
  if (settings_.with_point_lights && !rays_.scene().lights.empty()) {
    const auto brdf = make_brdf(rays_.scene(), hit, -direction, ray_tracing::Lobes::all);
    light.direct += reflected_point_lights(rays_, lights_, hit, brdf, rays);
  }
  const scene::Scene& scene = rays_.scene();
  if (settings_.with_glossy_rays &&
      scene.materials[static_cast<std::size_t>(hit.material)].is_glossy()) {
    add_glossy(hit, -direction, numbers.next(), light, rays);
  }
  const glm::vec3 albedo = ray_tracing::diffuse_albedo(scene, hit);
  if (albedo == glm::vec3(0.0F)) return light;
  const AtlasLookup::Taps taps = lookup_.taps(hit);
  const Side side = seen_side(hit, direction);
  for (std::size_t i = 0; i < static_cast<std::size_t>(taps.count); ++i) {
    const std::uint32_t index = texel_atlas::side_index(taps.texels[i], side);
    light.indirect += taps.weights[i] * albedo * solution_.indirect(index);
    if (settings_.with_direct) {
      light.direct += taps.weights[i] * albedo * solution_.direct_of_bundles(index);
    }
  }
  return light;
}

/// The lobe of the surface that the camera sees, by one ray along it.
void AtlasViewer::add_glossy(const Hit& hit, const glm::vec3& to_viewer, const glm::vec4& u,
                             Light& light, std::uint64_t& rays) const {
  ray_tracing::SurfaceBrdf lobe = make_brdf(rays_.scene(), hit, to_viewer, ray_tracing::Lobes::all);
  lobe.diffuse = glm::vec3(0.0F);
  lobe.glossy_share = 1.0F;
  const ray_tracing::BrdfSample drawn = sample(lobe, 0.0F, {u.x, u.y});
  if (drawn.value == glm::vec3(0.0F)) return;
  const glm::vec3 weight = drawn.value / drawn.pdf;
  ++rays;
  Hit seen;
  if (!rays_.intersect(ray_from(hit, drawn.direction), seen)) {
    if (settings_.with_emission) light.direct += weight * lights_.environment(drawn.direction);
    return;
  }
  if (settings_.with_emission) light.direct += weight * lights_.emission(seen, -drawn.direction);
  light.indirect += weight * leaving(seen, drawn.direction);
}

/// Radiance that a surface reflects by its Lambert lobe, by the atlas. @param direction  of the
/// look
glm::vec3 AtlasViewer::leaving(const Hit& hit, const glm::vec3& direction) const {
  const AtlasLookup::Taps taps = lookup_.taps(hit);
  const Side side = seen_side(hit, direction);
  glm::vec3 incident(0.0F);
  for (std::size_t i = 0; i < static_cast<std::size_t>(taps.count); ++i) {
    const std::uint32_t index = texel_atlas::side_index(taps.texels[i], side);
    incident += taps.weights[i] * (solution_.direct(index) + solution_.indirect(index));
  }
  return ray_tracing::diffuse_albedo(rays_.scene(), hit) * incident;
}

/// Looks through the pixels of tiles: the rays of one sample of each pixel are a packet.
class TileView {
 public:
  TileView(const ray_tracing::RayScene& rays, const AtlasViewer& viewer, const RenderJob& job,
           const PictureSettings& settings, AtlasPicture& picture)
      : rays_(rays),
        viewer_(viewer),
        camera_(job.camera, job.width_px, job.height_px),
        settings_(settings),
        picture_(picture) {}

  /// @return rays beyond the camera's
  std::uint64_t show(const ray_tracing::PixelTile& tile) const;

 private:
  const ray_tracing::RayScene& rays_;
  const AtlasViewer& viewer_;
  ray_tracing::CameraRays camera_;
  const PictureSettings& settings_;
  AtlasPicture& picture_;
};

std::uint64_t TileView::show(const ray_tracing::PixelTile& tile) const {
  const auto width = static_cast<std::size_t>(picture_.direct.width_px);
  const std::size_t count = tile.count;
  std::uint64_t rays = 0;
  std::array<AtlasViewer::Light, ray_tracing::kPacketRays> sums;
  std::array<std::size_t, ray_tracing::kPacketRays> pixels{};
  for (std::size_t i = 0; i < count; ++i) {
    pixels[i] = static_cast<std::size_t>(tile.pixels[i].y) * width +
                static_cast<std::size_t>(tile.pixels[i].x);
  }
  std::array<ray_tracing::Ray, ray_tracing::kPacketRays> packet;
  std::array<ray_tracing::LineHit, ray_tracing::kPacketRays> hits;
  std::vector<ray_tracing::SampleSequence> numbers;
  for (int sample = 0; sample < settings_.camera_rays; ++sample) {
    numbers.clear();
    for (std::size_t i = 0; i < count; ++i) {
      numbers.emplace_back(ray_tracing::SequenceKind::sobol,
                           ray_tracing::hash_combine(settings_.seed, pixels[i]),
                           static_cast<std::uint32_t>(sample));
      const glm::vec2 place = glm::vec2(tile.pixels[i]) + glm::vec2(numbers[i].next());
      packet[i] = camera_.through(place.x, place.y);
    }
    const std::uint32_t found = rays_.nearest(std::span(packet).first(count), hits);
    for (std::size_t i = 0; i < count; ++i) {
      const glm::vec3& direction = packet[i].direction;
      const bool is_hit = ((found >> i) & 1U) != 0;
      const AtlasViewer::Light light =
          is_hit ? viewer_.at(rays_.hit_at(hits[i]), direction, numbers[i], rays)
                 : viewer_.outside(direction);
      sums[i].direct += light.direct;
      sums[i].indirect += light.indirect;
    }
  }
  const float weight = 1.0F / static_cast<float>(settings_.camera_rays);
  for (std::size_t i = 0; i < count; ++i) {
    store(picture_.direct, pixels[i], weight * sums[i].direct);
    store(picture_.indirect, pixels[i], weight * sums[i].indirect);
  }
  return rays;
}

}  // namespace

AtlasLookup::Taps AtlasLookup::taps(const ray_tracing::SurfacePoint& point) const {
  const std::uint32_t own = atlas_.texel_at(point.object, point.triangle, point.barycentrics);
  Taps taps;
  if (own == texel_atlas::kNoTexel) return taps;
  const texel_atlas::ChartPlace& place = atlas_.layout().places[atlas_.texels()[own].chart];
  const glm::vec2 at = atlas_.position(point.object, point.triangle, point.barycentrics) - 0.5F;
  const glm::ivec2 low(glm::floor(at));
  const glm::vec2 share = at - glm::vec2(low);
  const auto cell_area_m2 = static_cast<float>(1.0 / (place.texels_per_m.x * place.texels_per_m.y));
  float sum = 0.0F;
  for (int corner = 0; corner < 4; ++corner) {
    const glm::ivec2 step(corner % 2, corner / 2);
    const glm::ivec2 cell = low + step;
    const glm::ivec2 inside = cell - place.corner;
    if (inside.x < 0 || inside.y < 0 || inside.x >= place.size.x || inside.y >= place.size.y) {
      continue;
    }
    const std::uint32_t texel = atlas_.texel_in(cell);
    if (texel == texel_atlas::kNoTexel) continue;
    const float covered = std::min(1.0F, atlas_.texels()[texel].area_m2 / cell_area_m2);
    const float weight = covered * (step.x == 1 ? share.x : 1.0F - share.x) *
                         (step.y == 1 ? share.y : 1.0F - share.y);
    const auto slot = static_cast<std::size_t>(taps.count++);
    taps.texels[slot] = texel;
    taps.weights[slot] = weight;
    sum += weight;
  }
  if (sum <= 0.0F) return {{own}, {1.0F}, 1};
  for (float& weight : taps.weights) weight /= sum;
  return taps;
}

AtlasPicture show_atlas(const ray_tracing::RayScene& rays, const texel_atlas::TexelAtlas& atlas,
                        const LightSolution& solution, const RenderJob& job,
                        const PictureSettings& settings) {
  const AtlasViewer viewer(rays, atlas, solution, settings);
  AtlasPicture picture{black(job), black(job), 0};
  const TileView view(rays, viewer, job, settings, picture);
  std::atomic<std::uint64_t> further_rays = 0;
  ray_tracing::for_each_tile(job.width_px, job.height_px, [&](const ray_tracing::PixelTile& tile) {
    further_rays.fetch_add(view.show(tile), std::memory_order_relaxed);
  });
  const std::size_t pixels = picture.direct.pixel_count();
  picture.rays = further_rays + pixels * static_cast<std::uint64_t>(settings.camera_rays);
  return picture;
}

std::vector<perception::NamedImage> show_texels(const ray_tracing::RayScene& rays,
                                                const texel_atlas::TexelAtlas& atlas,
                                                const RenderJob& job) {
  const ray_tracing::CameraRays camera(job.camera, job.width_px, job.height_px);
  Image albedo = black(job);
  Image normal = black(job);
  Image chart = black(job);
  Image density = perception::make_gray_image(job.width_px, job.height_px, "Y",
                                              perception::Encoding::scene_linear);
  const auto show_pixel = [&](std::size_t pixel) {
    const auto width = static_cast<std::size_t>(job.width_px);
    const ray_tracing::Ray ray = camera.through(static_cast<float>(pixel % width) + 0.5F,
                                                static_cast<float>(pixel / width) + 0.5F);
    Hit hit;
    if (!rays.intersect(ray, hit)) return;
    const float sign = seen_side(hit, ray.direction) == Side::front ? 1.0F : -1.0F;
    store(albedo, pixel, ray_tracing::diffuse_albedo(rays.scene(), hit));
    store(normal, pixel, sign * hit.shading_normal);
    const std::uint32_t index = atlas.texel_at(hit.object, hit.triangle, hit.barycentrics);
    if (index == texel_atlas::kNoTexel) return;
    const texel_atlas::Texel& texel = atlas.texels()[index];
    const bool is_dark = (texel.cell.x + texel.cell.y) % 2 == 0;
    store(chart, pixel, (is_dark ? 0.7F : 1.0F) * color_of(texel.chart));
    const glm::dvec2& along = atlas.layout().places[texel.chart].texels_per_m;
    density.pixels[pixel] = static_cast<float>(std::sqrt(along.x * along.y));
  };
  base::parallel_for(albedo.pixel_count(), kPixelGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t pixel = begin; pixel < end; ++pixel) show_pixel(pixel);
  });
  std::vector<perception::NamedImage> images;
  images.push_back({"albedo", std::move(albedo)});
  images.push_back({"normal", std::move(normal)});
  images.push_back({"atlas_chart", std::move(chart)});
  images.push_back({"atlas_density", std::move(density)});
  return images;
}

}  // namespace renderers::ray_bundles
