#include "renderers/opengl/gpu_scene.h"

#include <bit>
#include <cmath>
#include <memory>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "renderers/ray_tracing/ray_scene.h"
#include "tests/expect_error.h"
#include "tests/renderers/opengl/platform_test.h"
#include "tests/renderers/opengl/surface_oracle.h"

namespace renderers::opengl {
namespace {

class GpuSceneGlTest : public PlatformTest {
 protected:
  StageTimer timer_;
};
INSTANTIATE_TEST_SUITE_P(Platforms, GpuSceneGlTest, all_platforms(), platform_label);

TEST_P(GpuSceneGlTest, HoldsTheTrianglesOfRayTracing) {
  const scene::Scene scene = surface_scene();
  const ray_tracing::RayScene ray_scene(scene, timer_);
  GpuScene gpu_scene(context_);
  gpu_scene.load(scene, timer_);
  ASSERT_EQ(gpu_scene.triangle_count(), static_cast<int>(scene.face_count()));
  EXPECT_EQ(gpu_scene.bounds().least, ray_scene.box_min());
  EXPECT_EQ(gpu_scene.bounds().greatest, ray_scene.box_max());
  EXPECT_TRUE(gpu_scene.has_glossy());
  const auto triangles = gpu_scene.triangles().read<GpuTriangle>(scene.face_count());
  std::size_t index = 0;
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
    const auto count = static_cast<std::uint32_t>(scene.objects[object].mesh->triangles.size());
    for (std::uint32_t i = 0; i < count; ++i, ++index) {
      const GpuTriangle& triangle = triangles[index];
      EXPECT_EQ(std::bit_cast<int>(triangle.geometric_normal.w), scene.objects[object].material);
      if (!(ray_scene.triangle_area_m2(object, i) > 0.0F)) {
        EXPECT_EQ(glm::vec3(triangle.geometric_normal), glm::vec3(0.0F));
        continue;
      }
      // Half-way between the corners: the weights stay clear of the edges.
      const auto point = ray_scene.point_on_triangle(object, i, {0.25F, 0.25F});
      const glm::vec3 center = 0.5F * glm::vec3(triangle.position[0]) +
                               0.25F * glm::vec3(triangle.position[1] + triangle.position[2]);
      EXPECT_LT(glm::length(center - point.position), 1e-5F);
      EXPECT_LT(glm::length(glm::vec3(triangle.geometric_normal) - point.geometric_normal), 1e-6F);
    }
  }
}

TEST_P(GpuSceneGlTest, StagesItsWork) {
  GpuScene gpu_scene(context_);
  gpu_scene.load(surface_scene(), timer_);
  ASSERT_EQ(timer_.records().size(), 2U);
  EXPECT_EQ(timer_.records()[0].path, "triangles");
  EXPECT_EQ(timer_.records()[1].path, "upload");
  EXPECT_EQ(timer_.records()[1].bytes_gpu, gpu_scene.memory_bytes());
}

/// The next frame may be smaller, larger, painted differently.
TEST_P(GpuSceneGlTest, FollowsTheScene) {
  scene::Scene scene = surface_scene();
  GpuScene gpu_scene(context_);
  gpu_scene.load(scene, timer_);
  const std::uint32_t triangles = gpu_scene.triangles().id();
  const std::uint32_t texels = gpu_scene.texels().id();
  EXPECT_EQ(gpu_scene.texels().read<glm::vec4>(1)[0].y, scene.textures[0].image.pixels[1]);

  scene.textures[0].image.pixels[1] = 0.125F;  // in place: same address, same size
  scene.objects.pop_back();
  scene.materials[2].lobe.albedo = glm::vec3(0.0F);
  gpu_scene.load(scene, timer_);
  EXPECT_EQ(gpu_scene.triangles().id(), triangles);
  EXPECT_EQ(gpu_scene.texels().id(), texels);
  EXPECT_EQ(gpu_scene.texels().read<glm::vec4>(1)[0].y, 0.125F);
  EXPECT_EQ(gpu_scene.triangle_count(), static_cast<int>(scene.face_count()));
  EXPECT_FALSE(gpu_scene.has_glossy());

  EXPECT_FALSE(gpu_scene.has_ggx());
  scene.materials[2].lobe = {glm::vec3(0.0F), scene::LobeShape::ggx, 0.0F, 0.25F};
  gpu_scene.load(scene, timer_);
  EXPECT_FALSE(gpu_scene.has_ggx()) << "black";
  scene.materials[static_cast<std::size_t>(scene.objects[0].material)].lobe = {
      glm::vec3(0.5F), scene::LobeShape::ggx, 0.0F, 0.25F};
  gpu_scene.load(scene, timer_);
  EXPECT_TRUE(gpu_scene.has_ggx());
  EXPECT_EQ(gpu_scene.materials()
                .read<GpuMaterial>(3)[static_cast<std::size_t>(scene.objects[0].material)]
                .lobe,
            glm::vec4(0.5F, 0.5F, 0.5F, -0.25F));

  scene.materials[1].albedo_texture = scene::kNoTexture;
  gpu_scene.load(scene, timer_);
  const auto materials = gpu_scene.materials().read<GpuMaterial>(3);
  EXPECT_EQ(std::bit_cast<int>(materials[1].albedo.w), -1);
}

TEST_P(GpuSceneGlTest, RefusesMoreTrianglesThanABlockHolds) {
  const std::size_t limit = static_cast<std::size_t>(context_->limits().storage_block_bytes);
  const std::size_t count = limit / sizeof(GpuTriangle) + 1;
  if (count > 10'000'000) GTEST_SKIP() << "blocks of " << limit << " bytes";
  auto mesh = std::make_shared<scene::Mesh>();
  mesh->positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh->triangles.assign(count, {0, 1, 2});
  scene::Scene scene;
  scene.materials.emplace_back();
  scene.objects.emplace_back().mesh = mesh;
  GpuScene gpu_scene(context_);
  tests::expect_error<UnsupportedError>(
      [&] { gpu_scene.load(scene, timer_); },
      fmt::format("the scene's triangles take {} bytes in one block; {} allows {}",
                  count * sizeof(GpuTriangle), context_->facts().renderer, limit));
}

}  // namespace
}  // namespace renderers::opengl
