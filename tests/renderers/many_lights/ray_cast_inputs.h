#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "renderers/many_lights/surface_image.h"
#include "renderers/many_lights/virtual_light.h"
#include "renderers/ray_tracing/ray_scene.h"

/// Surfaces and virtual lights by ray casting, for tests without a graphics context.
namespace renderers::test {

/// What the scene's camera sees through every pixel's centre.
/// @param offset_px  of all rays, to the right and down
many_lights::SurfaceImage cast_surfaces(const ray_tracing::RayScene& rays, int width_px,
                                        int height_px, const glm::vec2& offset_px = {0, 0});

/// The surface as a pixel, its normals turned to the side of `to_viewer`.
void put_surface(const scene::Scene& scene, const ray_tracing::SurfacePoint& point,
                 const glm::vec3& to_viewer, many_lights::SurfaceImage& surfaces,
                 std::size_t pixel);

/// An image without surfaces.
many_lights::SurfaceImage make_surfaces(int width_px, int height_px);

/// `count` virtual lights where the rays of a point or spot light end, directions by Halton points
/// of bases 2 and 3 from index 1, uniform over the sphere or the outer cone.
std::vector<many_lights::VirtualLight> cast_lights(const ray_tracing::RayScene& rays,
                                                   const scene::Light& light, int count);

/// A light on a flat surface.
many_lights::VirtualLight light_at(const glm::vec3& position, const glm::vec3& normal,
                                   const glm::vec3& flux);

/// Well-distributed numbers in [0, 1).
glm::vec4 numbers(std::uint64_t seed, std::uint32_t index);

}  // namespace renderers::test
