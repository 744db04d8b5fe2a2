#include "renderers/ray_bundles/bundle_frame.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "renderers/ray_tracing/direction_sampling.h"

namespace renderers::ray_bundles {

BoundingSphere sphere_around(const scene::Box& box) {
  // Room for what rounding puts outside; a single point gets some, too.
  constexpr float kRoom = 1.0001F;
  constexpr float kLeast_m = 1e-6F;
  return {0.5F * (box.least + box.greatest),
          std::max(kLeast_m, 0.5F * kRoom * glm::distance(box.least, box.greatest))};
}

BundleFrame::BundleFrame(const scene::Box& box, const BundleDirection& bundle, int lines_across)
    : direction(bundle.direction) {
  const BoundingSphere sphere = sphere_around(box);
  sphere_radius_m = sphere.radius_m;
  pixel_m = 2.0F * sphere.radius_m / static_cast<float>(lines_across);
  const ray_tracing::Frame3 frame = ray_tracing::frame_around(direction);
  const float cosine = std::cos(bundle.roll_rad);
  const float sine = std::sin(bundle.roll_rad);
  axis_x = cosine * frame.tangent + sine * frame.bitangent;
  axis_y = cosine * frame.bitangent - sine * frame.tangent;

  // Half extent of the box along each axis; one pixel more on both sides for rounding and jitter.
  const glm::vec3 half = 0.5F * (box.greatest - box.least);
  const float half_x = glm::dot(glm::abs(axis_x), half);
  const float half_y = glm::dot(glm::abs(axis_y), half);
  const auto lines = [&](float half_m) {
    return 2 + static_cast<int>(std::ceil(2.0F * half_m / pixel_m));
  };
  width_px = lines(half_x);
  height_px = lines(half_y);
  corner = sphere.center - sphere.radius_m * direction -
           (half_x + bundle.jitter_px.x * pixel_m) * axis_x -
           (half_y + bundle.jitter_px.y * pixel_m) * axis_y;
}

ray_tracing::Ray BundleFrame::line(int x, int y) const {
  const float right_m = (static_cast<float>(x) + 0.5F) * pixel_m;
  const float up_m = (static_cast<float>(y) + 0.5F) * pixel_m;
  return {corner + right_m * axis_x + up_m * axis_y, direction, line_m()};
}

BundlePoint BundleFrame::project(const glm::vec3& point) const {
  const glm::vec3 offset = point - corner;
  return {glm::vec2(glm::dot(offset, axis_x), glm::dot(offset, axis_y)) / pixel_m,
          glm::dot(offset, direction)};
}

}  // namespace renderers::ray_bundles
