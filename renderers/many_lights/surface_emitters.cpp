#include "renderers/many_lights/surface_emitters.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "renderers/many_lights/emitter_views.h"
#include "renderers/many_lights/halton.h"
#include "renderers/ray_tracing/direction_sampling.h"
#include "renderers/ray_tracing/environment_sampler.h"
#include "renderers/ray_tracing/piecewise_distribution.h"
#include "renderers/ray_tracing/sample_sequence.h"

namespace renderers::many_lights {

namespace {

constexpr double kPi = std::numbers::pi;

/// Height of an area light's points over its surface, of the scene's diagonal: clear of the
/// rounding of positions, small against everything that is seen.
constexpr float kHeightOverSurface = 1e-5F;

struct EmissiveTriangle {
  glm::vec3 corners[3];
  glm::vec3 normal{0.0F};  ///< unit length, front side
  glm::vec2 uvs[3]{};
  glm::dvec3 mean_radiance{0.0};  ///< its texture's mean taken in
  double area_m2 = 0.0;
  const scene::Material* material = nullptr;
};

glm::dvec3 mean_of(const scene::Texture& texture) {
  glm::dvec3 sum(0.0);
  const perception::Image& image = texture.image;
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    const std::size_t first = i * image.channels.size();
    sum += glm::dvec3(image.pixels[first], image.pixels[first + 1], image.pixels[first + 2]);
  }
  return sum / static_cast<double>(image.pixel_count());
}

glm::dvec3 mean_emission(const scene::Scene& scene, const scene::Material& material) {
  const glm::dvec3 emission(material.emission);
  if (material.emission_texture == scene::kNoTexture) return emission;
  return emission * mean_of(scene.textures[static_cast<std::size_t>(material.emission_texture)]);
}

/// @param made  its material and mean radiance are those of every triangle
void add_triangles(const scene::Object& object, const EmissiveTriangle& made,
                   std::vector<EmissiveTriangle>& triangles) {
  // Normals by the inverse transpose: a mirroring transform keeps the front side.
  const glm::mat3 normal_to_world = glm::transpose(glm::inverse(glm::mat3(object.to_world)));
  for (const glm::uvec3& indices : object.mesh->triangles) {
    EmissiveTriangle triangle = made;
    glm::vec3 local[3];
    for (glm::length_t i = 0; i < 3; ++i) {
      local[i] = object.mesh->positions[indices[i]];
      triangle.corners[i] = glm::vec3(object.to_world * glm::vec4(local[i], 1.0F));
      if (!object.mesh->uvs.empty()) triangle.uvs[i] = object.mesh->uvs[indices[i]];
    }
    const glm::vec3 front = normal_to_world * glm::cross(local[1] - local[0], local[2] - local[0]);
    const glm::dvec3 a(triangle.corners[0]);
    const glm::dvec3 ab = glm::dvec3(triangle.corners[1]) - a;
    const glm::dvec3 ac = glm::dvec3(triangle.corners[2]) - a;
    triangle.area_m2 = 0.5 * glm::length(glm::cross(ab, ac));
    if (triangle.area_m2 <= 0.0 || glm::dot(front, front) <= 0.0F) continue;
    triangle.normal = glm::normalize(front);
    triangles.push_back(triangle);
  }
}

std::vector<EmissiveTriangle> emissive_triangles(const scene::Scene& scene) {
  std::vector<EmissiveTriangle> triangles;
  for (const scene::Object& object : scene.objects) {
    const auto& material = scene.materials[static_cast<std::size_t>(object.material)];
    if (!material.is_emissive()) continue;
    EmissiveTriangle made;
    made.mean_radiance = mean_emission(scene, material);
    made.material = &material;
    add_triangles(object, made, triangles);
  }
  return triangles;
}

/// One of the points or directions that stand for an emitter; its views lie side by side.
struct Stand {
  int first_view = 0;
  glm::dvec3 flux{0.0};  ///< its part of the emitter's
};

/// Which of them a sample takes, in base 5, so that any run of samples is spread over all.
const Stand& stand_of(const std::vector<Stand>& stands, int index, int count, int pass) {
  const auto point = static_cast<std::uint64_t>(index) + 1 +
                     static_cast<std::uint64_t>(pass) * static_cast<std::uint64_t>(count);
  return stands[static_cast<std::size_t>(radical_inverse(point, 5) *
                                         static_cast<double>(stands.size()))];
}

/// The golden ratio, sqrt(2) and sqrt(3), less 1: fractions of their multiples fill the cube evenly
/// over the point sets (Weyl 1916, doi:10.1007/BF01475864: they and 1 are linearly independent over
/// the rationals), and keep no step with the radical inverses by which samples take their points.
/// With radical inverses of i + K set here, point i of 16 would never leave a sixteenth of u.x.
constexpr glm::dvec3 kPointSetStep{0.6180339887498949, 0.41421356237309505, 0.7320508075688772};

float below_one(double value) {
  return std::min(static_cast<float>(value), ray_tracing::kBelowOne);  // floats round up to 1
}

/// The i-th of K numbers in [0, 1), one in each K-th; another place within it for every point set.
float stratified(int i, int count, int point_set) {
  return below_one((i + glm::fract(0.5 + point_set * kPointSetStep.x)) / count);
}

/// Two more coordinates for it in [0, 1): spread evenly over a set's numbers, and, for each of
/// them, over the sets.
glm::vec2 rotated(int i, int point_set) {
  const glm::dvec2 shift =
      static_cast<double>(point_set) * glm::dvec2(kPointSetStep.y, kPointSetStep.z);
  const glm::dvec2 u = glm::fract(halton_point(i, 1, 0) + shift);
  return {below_one(u.x), below_one(u.y)};
}

/// One of the points that stand for emissive triangles.
struct EmissionPoint {
  glm::vec3 position{0.0F};
  glm::dvec3 radiance{0.0};
};

EmissionPoint point_of(const scene::Scene& scene, const EmissiveTriangle& triangle,
                       const glm::vec2& u) {
  const glm::vec2 weights = ray_tracing::uniform_triangle(u);
  const float first = 1.0F - weights.x - weights.y;
  EmissionPoint point;
  point.position = first * triangle.corners[0] + weights.x * triangle.corners[1] +
                   weights.y * triangle.corners[2];
  point.radiance = glm::dvec3(triangle.material->emission);
  const int texture = triangle.material->emission_texture;
  if (texture == scene::kNoTexture) return point;
  const glm::vec2 uv =
      first * triangle.uvs[0] + weights.x * triangle.uvs[1] + weights.y * triangle.uvs[2];
  point.radiance *=
      glm::dvec3(scene::sample_texture(scene.textures[static_cast<std::size_t>(texture)], uv));
  return point;
}

/// The five faces around a point above a surface that look away from it, the first along `normal`.
std::vector<opengl::View> hemisphere_views(const glm::vec3& origin, const glm::vec3& normal) {
  std::vector<opengl::View> views = cube_views(origin, normal);
  const auto along = [&](const opengl::View& view) { return -glm::dot(view.forward, normal); };
  std::ranges::stable_sort(views, {}, along);
  views.pop_back();
  return views;
}

EmittedSample area_sample(const Emitter& emitter, const std::vector<Stand>& stands, int index,
                          int count, int pass) {
  const Stand& stand = stand_of(stands, index, count, pass);
  const auto views =
      std::span(emitter.views).subspan(static_cast<std::size_t>(stand.first_view), 5);
  const glm::dvec2 u = halton_point(index, count, pass);
  const double radius = std::sqrt(u.x);
  const double azimuth_rad = 2.0 * kPi * u.y;
  const glm::dvec3 towards = glm::dvec3(views[0].right) * (radius * std::cos(azimuth_rad)) +
                             glm::dvec3(views[0].up) * (radius * std::sin(azimuth_rad)) +
                             glm::dvec3(views[0].forward) * std::sqrt(1.0 - u.x);
  const MapPlace place = place_of(views, towards);
  const double share = static_cast<double>(stands.size()) / count;
  return {stand.first_view + place.view, place.position, stand.flux * share};
}

}  // namespace

Emitter area_emitter(const scene::Scene& scene, const EmitterSettings& settings) {
  Emitter emitter;
  emitter.kind = EmitterKind::area;
  assert(settings.area_light_points > 0);
  const std::vector<EmissiveTriangle> triangles = emissive_triangles(scene);
  std::vector<double> powers;
  for (const EmissiveTriangle& t : triangles) {
    const glm::dvec3 flux = kPi * t.area_m2 * t.mean_radiance;
    powers.push_back(luminance(flux));
    emitter.flux += flux;
  }
  const ray_tracing::PiecewiseDistribution choice(powers);
  if (choice.total() <= 0.0) return emitter;

  const float height_m = kHeightOverSurface * scene::bounding_box(scene).diagonal_m();
  const int count = settings.area_light_points;
  std::vector<Stand> stands;
  for (int i = 0; i < count; ++i) {
    const auto chosen = choice.choose(stratified(i, count, settings.point_set));
    const EmissiveTriangle& triangle = triangles[chosen.index];
    const EmissionPoint point = point_of(scene, triangle, rotated(i, settings.point_set));
    Stand stand;
    stand.first_view = static_cast<int>(emitter.views.size());
    stand.flux = point.radiance * (choice.total() / count / luminance(triangle.mean_radiance));
    const auto views =
        hemisphere_views(point.position + height_m * triangle.normal, triangle.normal);
    emitter.views.insert(emitter.views.end(), views.begin(), views.end());
    stands.push_back(stand);
  }
  emitter.sample = [shared = emitter, stands](int index, int samples, int pass) {
    return area_sample(shared, stands, index, samples, pass);
  };
  return emitter;
}

Emitter environment_emitter(const scene::Scene& scene, const EmitterSettings& settings) {
  Emitter emitter;
  emitter.kind = EmitterKind::environment;
  assert(settings.environment_directions > 0);
  const scene::Box box = scene::bounding_box(scene);
  const float radius_m = 0.5F * box.diagonal_m();
  if (!scene.environment || radius_m <= 0.0F) return emitter;
  const ray_tracing::EnvironmentSampler sampler(*scene.environment);
  if (sampler.power() <= 0.0) return emitter;

  const glm::vec3 center = 0.5F * (box.least + box.greatest);
  const double area_m2 = kPi * static_cast<double>(radius_m) * static_cast<double>(radius_m);
  const int count = settings.environment_directions;
  std::vector<Stand> stands;
  for (int i = 0; i < count; ++i) {
    // Directions go on with one sequence: a few sets together are as even as one set of them all.
    const double v = halton_point(i, count, settings.point_set).x;
    const double within = radical_inverse(static_cast<std::uint64_t>(settings.point_set) + 1, 2);
    const auto drawn = sampler.sample({below_one(v), below_one((i + within) / count)});
    if (drawn.pdf <= 0.0F) continue;
    opengl::View view = view_along(center + radius_m * drawn.direction, -drawn.direction);
    view.is_orthographic = true;
    view.half_width = radius_m;
    view.half_height = radius_m;
    const glm::dvec3 radiance(scene::sample_environment(*scene.environment, drawn.direction));
    stands.push_back({static_cast<int>(emitter.views.size()),
                      radiance * (area_m2 / (static_cast<double>(drawn.pdf) * count))});
    emitter.views.push_back(view);
    emitter.flux += stands.back().flux;
  }
  emitter.sample = [stands](int index, int samples, int pass) {
    const Stand& stand = stand_of(stands, index, samples, pass);
    const glm::dvec2 u = halton_point(index, samples, pass);
    const double radius = 0.5 * std::sqrt(u.x);
    const double azimuth_rad = 2.0 * kPi * u.y;
    const glm::dvec2 position(0.5 + radius * std::cos(azimuth_rad),
                              0.5 + radius * std::sin(azimuth_rad));
    const double share = static_cast<double>(stands.size()) / samples;
    return EmittedSample{stand.first_view, position, stand.flux * share};
  };
  return emitter;
}

}  // namespace renderers::many_lights
