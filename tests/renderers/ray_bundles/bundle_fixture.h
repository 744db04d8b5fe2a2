#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/ray_bundles/bundle_transport.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "renderers/texel_atlas/texel_atlas.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::test {

/// A scene with what bundles need. The scene must live as long.
struct BundleScene {
  explicit BundleScene(const scene::Scene& scene, int atlas_side_px = 64);
  StageTimer timer;
  ray_tracing::RayScene rays;
  texel_atlas::TexelAtlas atlas;
  scene::Box box;
};

/// A box of one mesh with shared corners, so that no line passes between its faces; objects of
/// SceneBuilder::add_box are six. @param inward  the front sides look into the box
int add_closed_box(SceneBuilder& builder, const glm::vec3& low, const glm::vec3& high, int material,
                   bool inward);

/// Boxes, a ball, and a ball of many small triangles, mirrored, in a closed room.
SceneBuilder closed_room();

/// J of a part of the surface: mean over sides by area, and extremes.
struct LightStatistics {
  glm::dvec3 mean{0.0};
  double least = 0.0;     ///< of the first channel
  double greatest = 0.0;  ///< of the first channel
};

enum class LightOf { direct, indirect, both };

/// @param object  -1: all
LightStatistics light_on(const BundleScene& built, const ray_bundles::LightSolution& solution,
                         LightOf part, int object = -1,
                         texel_atlas::Side side = texel_atlas::Side::front);

/// J of a uniform polygon at a point: Lambert's formula, sum of edge angles times the cosine of
/// their planes over 2 pi. Source: Baum, Rushmeier, Winget 1989, doi:10.1145/74334.74367.
/// @param normal  of the lit surface, unit length
double lambert_polygon(const std::vector<glm::dvec3>& corners, const glm::dvec3& point,
                       const glm::dvec3& normal);

/// Runs a number of directions.
ray_bundles::BundleTransport transported(BundleScene& built,
                                         const ray_bundles::TransportSettings& settings,
                                         std::int64_t directions);

}  // namespace renderers::test
