#include "renderers/many_lights/emitter_views.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "renderers/many_lights/halton.h"
#include "renderers/ray_tracing/direction_sampling.h"

namespace renderers::many_lights {

glm::dvec2 halton_point(int index, int count, int pass) {
  const auto point = static_cast<std::uint64_t>(index) + 1 +
                     static_cast<std::uint64_t>(pass) * static_cast<std::uint64_t>(count);
  return {radical_inverse(point, 2), radical_inverse(point, 3)};
}

opengl::View view_along(const glm::vec3& origin, const glm::vec3& forward) {
  const auto frame = ray_tracing::frame_around(forward);
  opengl::View view;
  view.origin = origin;
  view.right = frame.bitangent;
  view.up = frame.tangent;
  view.forward = forward;
  return view;
}

std::vector<opengl::View> cube_views(const glm::vec3& origin, const glm::vec3& axis) {
  const opengl::View along = view_along(origin, axis);
  const glm::mat3 axes(along.right, along.up, along.forward);
  std::vector<opengl::View> views;
  for (int face = 0; face < 6; ++face) views.push_back(opengl::cube_face(origin, axes, face));
  return views;
}

glm::dvec3 direction_through(const opengl::View& view, const glm::dvec2& map_position) {
  const double x = (2.0 * map_position.x - 1.0) * static_cast<double>(view.half_width);
  const double y = (2.0 * map_position.y - 1.0) * static_cast<double>(view.half_height);
  return glm::normalize(glm::dvec3(view.forward) + x * glm::dvec3(view.right) -
                        y * glm::dvec3(view.up));
}

double map_solid_angle_sr(const opengl::View& view, const glm::dvec2& map_position) {
  const double cosine = glm::dot(direction_through(view, map_position), glm::dvec3(view.forward));
  return 4.0 * static_cast<double>(view.half_width) * static_cast<double>(view.half_height) *
         cosine * cosine * cosine;
}

MapPlace place_of(std::span<const opengl::View> views, const glm::dvec3& direction) {
  const auto along = [&](const opengl::View& view) {
    return glm::dot(direction, glm::dvec3(view.forward));
  };
  const auto best = std::ranges::max_element(views, {}, along);
  const double depth = along(*best);
  const double x = glm::dot(direction, glm::dvec3(best->right)) / depth;
  const double y = glm::dot(direction, glm::dvec3(best->up)) / depth;
  // Directions at a face's edge may fall beyond it by a rounding.
  const glm::dvec2 position(0.5 + 0.5 * x / static_cast<double>(best->half_width),
                            0.5 - 0.5 * y / static_cast<double>(best->half_height));
  constexpr double kBelowOne = 1.0 - 1e-12;
  return {static_cast<int>(best - views.begin()),
          {std::clamp(position.x, 0.0, kBelowOne), std::clamp(position.y, 0.0, kBelowOne)}};
}

}  // namespace renderers::many_lights
