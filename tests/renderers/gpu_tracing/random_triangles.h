#pragma once

#include <cstdint>
#include <vector>

#include "renderers/gpu_tracing/triangle_bvh.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/scene/scene.h"

namespace renderers::test {

/// Triangles in the cube from -1 to 1, named by their index. @param size  of their edges, about
std::vector<gpu_tracing::BvhTriangle> random_triangles(std::size_t count, float size,
                                                       std::uint32_t seed);

/// Segments across the cube, half of them endless rays from inside it.
std::vector<ray_tracing::Ray> random_rays(std::size_t count, std::uint32_t seed);

/// The triangles as one object.
scene::Scene scene_of(const std::vector<gpu_tracing::BvhTriangle>& triangles);

}  // namespace renderers::test
