#include "renderers/clustered_visibility/cluster_images.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "perception/base/parallel.h"
#include "renderers/many_lights/gather_settings.h"

namespace renderers::clustered_visibility {

namespace {

using many_lights::SurfaceImage;
using perception::Image;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kDim = 0.15F;               ///< of surfaces under dots
constexpr float kDotShare = 1.0F / 250.0F;  ///< radius of a dot, of the picture's height
constexpr float kSeen = 0.01F;  ///< diagonals between a light and the surface seen there

Image black(const SurfaceImage& surfaces) {
  return perception::make_rgb_image(surfaces.width_px, surfaces.height_px,
                                    perception::Encoding::scene_linear);
}

void put(Image& image, std::size_t pixel, const glm::vec3& color) {
  for (glm::length_t channel = 0; channel < 3; ++channel) {
    image.pixels[pixel * 3 + static_cast<std::size_t>(channel)] = color[channel];
  }
}

int nearest_cluster(const ClusterState& state, const ClusterSettings& settings,
                    const glm::vec3& position, const glm::vec3& normal, float diagonal_m) {
  int nearest = -1;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t c = 0; c < state.area_lights.size(); ++c) {
    const AreaLight& area = state.area_lights[c];
    if (area.position.w == 0.0F) continue;
    const float cosine = std::clamp(glm::dot(normal, glm::vec3(area.axis)), -1.0F, 1.0F);
    const float d =
        settings.position_weight * glm::distance(position, glm::vec3(area.position)) / diagonal_m +
        settings.normal_weight * std::acos(cosine) / kPi;
    if (d < least) {
      least = d;
      nearest = static_cast<int>(c);
    }
  }
  return nearest;
}

/// Pixel of a point in front of the view; nothing behind it.
bool project(const opengl::View& view, const SurfaceImage& surfaces, const glm::vec3& point,
             glm::vec2& pixel) {
  const glm::vec3 to_point = point - view.origin;
  const float depth = glm::dot(to_point, view.forward);
  if (depth <= 0.0F) return false;
  const glm::vec2 plane(glm::dot(to_point, view.right) / depth,
                        glm::dot(to_point, view.up) / depth);
  pixel = {(1.0F + (plane.x - view.center.x) / view.half_width) * 0.5F *
               static_cast<float>(surfaces.width_px),
           (1.0F - (plane.y - view.center.y) / view.half_height) * 0.5F *
               static_cast<float>(surfaces.height_px)};
  return true;
}

void put_dot(Image& image, const SurfaceImage& surfaces, const glm::vec2& center,
             const glm::vec3& color) {
  const float radius = std::max(1.0F, kDotShare * static_cast<float>(surfaces.height_px));
  const auto first = [&](float at, int size) {
    return std::clamp(static_cast<int>(std::floor(at - radius)), 0, size);
  };
  const auto end = [&](float at, int size) {
    return std::clamp(static_cast<int>(std::ceil(at + radius)), 0, size);
  };
  for (int y = first(center.y, surfaces.height_px); y < end(center.y, surfaces.height_px); ++y) {
    for (int x = first(center.x, surfaces.width_px); x < end(center.x, surfaces.width_px); ++x) {
      const glm::vec2 middle(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
      if (glm::distance(middle, center) > radius) continue;
      put(image, static_cast<std::size_t>(y * surfaces.width_px + x), color);
    }
  }
}

}  // namespace

glm::vec3 cluster_color(int cluster) {
  constexpr float kGoldenTurn = 0.38196601F;
  const float hue = 6.0F * (kGoldenTurn * static_cast<float>(cluster) -
                            std::floor(kGoldenTurn * static_cast<float>(cluster)));
  const glm::vec3 wheel(std::fabs(hue - 3.0F) - 1.0F, 2.0F - std::fabs(hue - 2.0F),
                        2.0F - std::fabs(hue - 4.0F));
  constexpr float kSaturation = 0.8F;
  return glm::mix(glm::vec3(1.0F), glm::clamp(wheel, 0.0F, 1.0F), kSaturation);
}

Image cluster_image(const ClusterState& state, const ClusterSettings& settings,
                    const SurfaceImage& surfaces, float diagonal_m) {
  Image image = black(surfaces);
  base::parallel_for(surfaces.position.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      if (surfaces.position[pixel].w == 0.0F) continue;
      const int cluster = nearest_cluster(state, settings, glm::vec3(surfaces.position[pixel]),
                                          glm::vec3(surfaces.geometric_normal[pixel]), diagonal_m);
      const glm::vec3 albedo(surfaces.albedo[pixel]);
      const float shade = 0.5F + 0.5F * std::max({albedo.r, albedo.g, albedo.b});
      if (cluster >= 0) put(image, pixel, shade * cluster_color(cluster));
    }
  });
  return image;
}

Image light_image(const ClusterState& state, const opengl::View& view, const SurfaceImage& surfaces,
                  float diagonal_m) {
  Image image = black(surfaces);
  for (std::size_t pixel = 0; pixel < surfaces.position.size(); ++pixel) {
    if (surfaces.position[pixel].w == 0.0F) continue;
    const glm::vec3 to_view = glm::normalize(view.origin - glm::vec3(surfaces.position[pixel]));
    const float facing = std::fabs(glm::dot(to_view, glm::vec3(surfaces.shading_normal[pixel])));
    put(image, pixel, kDim * (0.4F + 0.6F * facing) * glm::vec3(1.0F));
  }
  for (std::size_t i = 0; i < state.lights.size(); ++i) {
    glm::vec2 at;
    const glm::vec3 position(state.lights[i].position);
    if (state.assignments[i] < 0 || !project(view, surfaces, position, at)) continue;
    const int x = static_cast<int>(std::floor(at.x));
    const int y = static_cast<int>(std::floor(at.y));
    if (x < 0 || y < 0 || x >= surfaces.width_px || y >= surfaces.height_px) continue;
    const glm::vec4& seen = surfaces.position[static_cast<std::size_t>(y * surfaces.width_px + x)];
    if (seen.w == 0.0F || glm::distance(glm::vec3(seen), position) > kSeen * diagonal_m) continue;
    put_dot(image, surfaces, at, cluster_color(state.assignments[i]));
  }
  return image;
}

Image light_count_image(const ClusterState& state, int interleave, const SurfaceImage& surfaces) {
  Image image = black(surfaces);
  const auto count = static_cast<int>(state.assignments.size());
  for (int y = 0; y < surfaces.height_px; ++y) {
    for (int x = 0; x < surfaces.width_px; ++x) {
      const auto pixel = static_cast<std::size_t>(y * surfaces.width_px + x);
      if (surfaces.position[pixel].w == 0.0F) continue;
      const many_lights::LightRun run = many_lights::light_run(x, y, interleave, count);
      const auto first = state.assignments.begin() + run.first;
      const auto lights =
          std::count_if(first, first + run.count, [](std::int32_t c) { return c >= 0; });
      put(image, pixel, glm::vec3(static_cast<float>(lights)));
    }
  }
  return image;
}

}  // namespace renderers::clustered_visibility
