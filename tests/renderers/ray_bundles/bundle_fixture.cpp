#include "tests/renderers/ray_bundles/bundle_fixture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

namespace renderers::test {

namespace {

texel_atlas::AtlasSettings atlas_settings(int side_px) {
  texel_atlas::AtlasSettings settings;
  settings.side_px = side_px;
  return settings;
}

}  // namespace

BundleScene::BundleScene(const scene::Scene& scene, int atlas_side_px)
    : rays(scene, timer, ray_tracing::RayQueries::all_hits),
      atlas(rays, atlas_settings(atlas_side_px), timer),
      box{rays.box_min(), rays.box_max()} {}

SceneBuilder closed_room() {
  SceneBuilder builder;
  const int wall = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_box(glm::vec3(-1.0F), {1.0F, 1.2F, 1.0F}, wall, true);
  builder.add_box({-0.6F, -0.9F, -0.5F}, {0.1F, -0.2F, 0.3F}, wall, false);
  builder.add_sphere({0.4F, 0.3F, 0.2F}, 0.45F, 12, wall);
  const int ball = builder.add_sphere({0.3F, 0.2F, -0.3F}, 0.5F, 60, wall);
  builder.scene.objects[static_cast<std::size_t>(ball)].to_world[0][0] = -0.8F;
  return builder;
}

int add_closed_box(SceneBuilder& builder, const glm::vec3& low, const glm::vec3& high, int material,
                   bool inward) {
  scene::Mesh mesh;
  for (unsigned i = 0; i < 8; ++i) {
    mesh.positions.push_back(
        {(i & 1U) ? high.x : low.x, (i & 2U) ? high.y : low.y, (i & 4U) ? high.z : low.z});
  }
  // Corners of the faces, counter-clockwise seen from inside.
  constexpr unsigned kFaces[6][4] = {{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1},
                                     {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}};
  for (const auto& face : kFaces) {
    for (const unsigned i : {1U, 2U}) {
      glm::uvec3 triangle(face[0], face[i], face[i + 1]);
      if (!inward) std::swap(triangle.y, triangle.z);
      mesh.triangles.push_back(triangle);
    }
  }
  scene::Object object;
  object.mesh = std::make_shared<const scene::Mesh>(std::move(mesh));
  object.material = material;
  builder.scene.objects.push_back(std::move(object));
  return static_cast<int>(builder.scene.objects.size()) - 1;
}

LightStatistics light_on(const BundleScene& built, const ray_bundles::LightSolution& solution,
                         LightOf part, int object, texel_atlas::Side side) {
  LightStatistics statistics;
  statistics.least = std::numeric_limits<double>::infinity();
  statistics.greatest = -statistics.least;
  double area_m2 = 0.0;
  for (std::uint32_t i = 0; i < built.atlas.texels().size(); ++i) {
    const texel_atlas::Texel& texel = built.atlas.texels()[i];
    if (object >= 0 && static_cast<int>(texel.point.object) != object) continue;
    const std::uint32_t index = texel_atlas::side_index(i, side);
    glm::dvec3 light(0.0);
    if (part != LightOf::indirect) light += glm::dvec3(solution.direct(index));
    if (part != LightOf::direct) light += glm::dvec3(solution.indirect(index));
    const auto weight = static_cast<double>(texel.area_m2);
    statistics.mean += weight * light;
    area_m2 += weight;
    statistics.least = std::min(statistics.least, light.x);
    statistics.greatest = std::max(statistics.greatest, light.x);
  }
  statistics.mean /= area_m2;
  return statistics;
}

double lambert_polygon(const std::vector<glm::dvec3>& corners, const glm::dvec3& point,
                       const glm::dvec3& normal) {
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 a = glm::normalize(corners[i] - point);
    const glm::dvec3 b = glm::normalize(corners[(i + 1) % corners.size()] - point);
    const glm::dvec3 plane = glm::normalize(glm::cross(a, b));
    sum += std::acos(glm::dot(a, b)) * glm::dot(plane, normal);
  }
  return std::fabs(sum) / (2.0 * std::numbers::pi);
}

ray_bundles::BundleTransport transported(BundleScene& built,
                                         const ray_bundles::TransportSettings& settings,
                                         std::int64_t directions) {
  ray_bundles::TransportSettings planned = settings;
  planned.planned = directions;
  ray_bundles::BundleTransport transport(built.rays, built.atlas, planned, built.timer);
  for (std::int64_t i = 0; i < directions; ++i) transport.add_direction(built.timer);
  transport.fetch(built.timer);
  return transport;
}

}  // namespace renderers::test
