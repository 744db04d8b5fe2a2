#include "renderers/ray_bundles/glossy_view.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"
#include "renderers/ray_tracing/camera_rays.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "renderers/ray_tracing/surface_brdf.h"

namespace renderers::ray_bundles {

GlossyView::GlossyView(const ray_tracing::RayScene& rays, const texel_atlas::TexelAtlas& atlas,
                       const RenderJob& job, const GlossyViewSettings& settings)
    : rays_(rays),
      atlas_(atlas),
      job_(job),
      settings_(settings),
      sums_(static_cast<std::size_t>(job.width_px) * static_cast<std::size_t>(job.height_px)) {}

void GlossyView::look(std::uint64_t seed, std::uint32_t pass) {
  constexpr std::size_t kGrain = 1024;
  const ray_tracing::CameraRays camera(job_.camera, job_.width_px, job_.height_px);
  const auto width = static_cast<std::size_t>(job_.width_px);
  const auto point_at = [&](std::size_t pixel) -> std::optional<Point> {
    ray_tracing::SampleSequence numbers(ray_tracing::SequenceKind::sobol,
                                        ray_tracing::hash_combine(seed, pixel), pass);
    const glm::vec4 u = numbers.next();
    const ray_tracing::Ray ray = camera.through(static_cast<float>(pixel % width) + u.x,
                                                static_cast<float>(pixel / width) + u.y);
    ray_tracing::Hit hit;
    if (!rays_.intersect(ray, hit)) return std::nullopt;
    const scene::Material& material =
        rays_.scene().materials[static_cast<std::size_t>(hit.material)];
    const std::uint32_t texel = atlas_.texel_at(hit.object, hit.triangle, hit.barycentrics);
    if (!material.is_glossy() || texel == texel_atlas::kNoTexel) return std::nullopt;
    const ray_tracing::SurfaceBrdf brdf =
        make_brdf(rays_.scene(), hit, -ray.direction, ray_tracing::Lobes::all);
    Point point;
    point.pixel = pixel;
    point.texel = texel;
    point.surface = {hit.position, 0.0F, brdf.geometric_normal, brdf.normal};
    point.sees_front = glm::dot(hit.geometric_normal, ray.direction) < 0.0F;
    point.glossy = brdf.glossy;
    return point;
  };
  std::vector<std::optional<Point>> found(sums_.size());
  base::parallel_for(sums_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t pixel = begin; pixel < end; ++pixel) found[pixel] = point_at(pixel);
  });
  points_.clear();
  for (const std::optional<Point>& point : found) {
    if (point) points_.push_back(*point);
  }
  camera_rays_ += sums_.size();
}

void GlossyView::add(const Bundle& bundle, const LightSolution& solution) {
  constexpr std::size_t kGrain = 512;
  base::parallel_for(points_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) add_point(points_[i], bundle, solution);
  });
  weights_ += static_cast<double>(bundle.weight);
}

void GlossyView::add_point(const Point& point, const Bundle& bundle,
                           const LightSolution& solution) {
  Sum& sum = sums_[point.pixel];
  // Lists know the front by its own normal.
  ExchangeTexel surface = point.surface;
  if (!point.sees_front) {
    surface.geometric_normal = -surface.geometric_normal;
    surface.shading_normal = -surface.shading_normal;
  }
  const auto partners = find_partners(surface, point.texel, bundle);
  const float share = 2.0F * bundle.weight *
                      std::fabs(glm::dot(point.surface.shading_normal, bundle.frame.direction));
  (partners ? sum.met : sum.missed) += share;
  if (!partners) return;
  const glm::vec3& along = bundle.frame.direction;
  const bool looks_back = glm::dot(point.surface.geometric_normal, along) < 0.0F;
  const glm::vec3 to_light = looks_back ? -along : along;
  const float cosine = glm::dot(point.surface.shading_normal, to_light);
  const float value = cosine > 0.0F ? lobe_value(point.glossy, to_light) : 0.0F;
  if (value <= 0.0F) return;
  // 2 pi f |n . w|
  const glm::vec3 weight =
      point.glossy.lobe.albedo * (2.0F * ray_tracing::kPi * value * bundle.weight * cosine);
  const Sender& sender = looks_back ? partners->before : partners->after;
  if (is_end(sender.side)) {
    const EndLight& ends = bundle.ends;
    if (settings_.with_emission) sum.direct += weight * (looks_back ? ends.behind : ends.ahead);
    return;
  }
  const SentLight light = light_of(sender, partners->line_px, bundle, solution);
  if (settings_.with_emission) sum.direct += weight * light.emitted;
  glm::vec3 reflected = light.reflected;
  if (!settings_.with_diffuse) reflected -= light.reflected_diffuse;
  sum.indirect += weight * reflected;
}

void GlossyView::add_to(perception::Image& direct, perception::Image& indirect) const {
  for (std::size_t pixel = 0; pixel < sums_.size(); ++pixel) {
    const Sum& sum = sums_[pixel];
    if (sum.met <= 0.0F) continue;
    // Bundles that met the point stand for those that missed it.
    const auto weight = static_cast<float>((sum.met + sum.missed) / (sum.met * weights_));
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const auto c = static_cast<glm::length_t>(channel);
      direct.pixels[3 * pixel + channel] += weight * sums_[pixel].direct[c];
      indirect.pixels[3 * pixel + channel] += weight * sums_[pixel].indirect[c];
    }
  }
}

}  // namespace renderers::ray_bundles
