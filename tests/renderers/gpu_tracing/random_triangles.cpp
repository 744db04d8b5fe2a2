#include "tests/renderers/gpu_tracing/random_triangles.h"

#include <memory>
#include <random>

#include "tests/renderers/scene_builder.h"

namespace renderers::test {

namespace {

/// Coordinates that are the same with every standard library.
class Cube {
 public:
  explicit Cube(std::uint32_t seed) : numbers_(seed) {}
  glm::vec3 point() { return {coordinate(), coordinate(), coordinate()}; }

 private:
  float coordinate() { return static_cast<float>(numbers_() >> 8) * 0x1p-23F - 1.0F; }
  std::mt19937 numbers_;
};

}  // namespace

std::vector<gpu_tracing::BvhTriangle> random_triangles(std::size_t count, float size,
                                                       std::uint32_t seed) {
  Cube cube(seed);
  std::vector<gpu_tracing::BvhTriangle> triangles(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::vec3 a = cube.point();
    triangles[i] = {a, 0, a + size * cube.point(), i, a + size * cube.point(), 0};
  }
  return triangles;
}

std::vector<ray_tracing::Ray> random_rays(std::size_t count, std::uint32_t seed) {
  Cube cube(seed);
  std::vector<ray_tracing::Ray> rays(count);
  for (std::size_t i = 0; i < count; ++i) {
    rays[i].origin = 1.5F * cube.point();
    rays[i].direction = 1.5F * cube.point() - rays[i].origin;
    if (i % 2 == 0) rays[i].t_max = ray_tracing::kSegmentEnd;
  }
  return rays;
}

scene::Scene scene_of(const std::vector<gpu_tracing::BvhTriangle>& triangles) {
  SceneBuilder builder;
  auto mesh = std::make_shared<scene::Mesh>();
  for (const gpu_tracing::BvhTriangle& t : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh->positions.size());
    mesh->positions.insert(mesh->positions.end(), {t.a, t.b, t.c});
    mesh->triangles.emplace_back(first, first + 1, first + 2);
  }
  scene::Object object;
  object.mesh = mesh;
  object.material = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.scene.objects.push_back(object);
  return builder.scene;
}

}  // namespace renderers::test
