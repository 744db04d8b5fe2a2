#include "renderers/texel_atlas/texel_atlas.h"

#include <cmath>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <set>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "renderers/texel_atlas/world_triangles.h"
#include "tests/expect_input_error.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::texel_atlas {
namespace {

using test::SceneBuilder;

/// A scene with its rays and atlas.
struct Built {
  Built(const scene::Scene& scene, const AtlasSettings& settings)
      : rays(scene, timer), atlas(rays, settings, timer) {}
  StageTimer timer;
  ray_tracing::RayScene rays;
  TexelAtlas atlas;
};

/// Walls, a sphere with smooth normals, a mirrored and skewed copy of it.
SceneBuilder mixed_scene() {
  SceneBuilder builder;
  const int wall = builder.add_material(test::lambert({0.7F, 0.6F, 0.5F}));
  builder.add_box(glm::vec3(-1.0F), {1.0F, 1.5F, 1.0F}, wall, true);
  const int ball = builder.add_sphere({0.2F, -0.3F, 0.1F}, 0.4F, 9, wall);
  scene::Object copy = builder.scene.objects[static_cast<std::size_t>(ball)];
  copy.to_world = glm::scale(glm::mat4(1.0F), {-0.7F, 0.5F, 0.3F});
  builder.scene.objects.push_back(copy);
  return builder;
}

AtlasSettings settings_for(ChartKind kind, int side_px, double texels_per_m = 0.0) {
  AtlasSettings settings;
  settings.charts.kind = kind;
  settings.side_px = side_px;
  settings.texels_per_m = texels_per_m;
  return settings;
}

double area_of_texels(const TexelAtlas& atlas) {
  double sum = 0.0;
  for (const Texel& texel : atlas.texels()) sum += static_cast<double>(texel.area_m2);
  return sum;
}

TEST(TexelAtlas, AreasOfTexelsSumToTheArea) {
  const SceneBuilder builder = mixed_scene();
  const double area_m2 = world_triangles(builder.scene).area_m2();
  for (const ChartKind kind : {ChartKind::triangle, ChartKind::connected}) {
    for (const int side_px : {128, 300}) {
      const Built built(builder.scene, settings_for(kind, side_px));
      EXPECT_NEAR(area_of_texels(built.atlas), area_m2, 1e-4 * area_m2);
      // Without the exact cut, a texel would count a whole cell: far too much.
      double cells_m2 = 0.0;
      for (const Texel& texel : built.atlas.texels()) {
        const glm::dvec2 density = built.atlas.layout().places[texel.chart].texels_per_m;
        cells_m2 += 1.0 / (density.x * density.y);
      }
      EXPECT_GT(std::abs(cells_m2 - area_m2), 1e-3 * area_m2);
    }
  }
}

TEST(TexelAtlas, PointsLieInTheirTrianglesAndTexels) {
  const SceneBuilder builder = mixed_scene();
  for (const ChartKind kind : {ChartKind::triangle, ChartKind::connected}) {
    const Built built(builder.scene, settings_for(kind, 256));
    const TexelAtlas& atlas = built.atlas;
    const WorldTriangles world = world_triangles(builder.scene);
    for (std::uint32_t i = 0; i < atlas.texels().size(); ++i) {
      const Texel& texel = atlas.texels()[i];
      const auto& point = texel.point;
      ASSERT_GE(point.barycentrics.x, 0.0F);
      ASSERT_GE(point.barycentrics.y, 0.0F);
      ASSERT_LE(point.barycentrics.x + point.barycentrics.y, 1.0F + 1e-6F);
      ASSERT_EQ(atlas.texel_at(point.object, point.triangle, point.barycentrics), i);
      const WorldTriangle& triangle = world.triangles[world.index_of(point.object, point.triangle)];
      const glm::dvec3 normal = glm::normalize(triangle.scaled_normal());
      ASSERT_NEAR(glm::dot(normal, glm::dvec3(point.position) - triangle.corners[0]), 0.0, 1e-6);
      ASSERT_GT(glm::dot(normal, glm::dvec3(point.geometric_normal)), 0.9999);
      ASSERT_GT(texel.area_m2, 0.0F);
    }
  }
}

TEST(TexelAtlas, EveryPointOfATriangleHasATexelOfItsChart) {
  const SceneBuilder builder = mixed_scene();
  const Built built(builder.scene, settings_for(ChartKind::connected, 200));
  for (std::uint32_t object = 0; object < builder.scene.objects.size(); ++object) {
    const auto count = builder.scene.objects[object].mesh->triangles.size();
    for (std::uint32_t triangle = 0; triangle < count; ++triangle) {
      if (built.rays.triangle_area_m2(object, triangle) < 1e-9F) continue;
      for (const glm::vec2 place : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1),
                                    glm::vec2(0.5F, 0.5F), glm::vec2(0.2F, 0.3F)}) {
        const std::uint32_t texel = built.atlas.texel_at(object, triangle, place);
        ASSERT_NE(texel, kNoTexel) << object << " " << triangle;
        ASSERT_EQ(built.atlas.texels()[texel].chart, built.atlas.chart_of(object, triangle));
      }
    }
  }
}

TEST(TexelAtlas, ChartsKeepTheirDistance) {
  const SceneBuilder builder = mixed_scene();
  for (const ChartKind kind : {ChartKind::triangle, ChartKind::connected}) {
    const Built built(builder.scene, settings_for(kind, 256));
    const TexelAtlas& atlas = built.atlas;
    for (const Texel& texel : atlas.texels()) {
      for (int y = std::max(0, texel.cell.y - 2); y <= std::min(255, texel.cell.y + 2); ++y) {
        for (int x = std::max(0, texel.cell.x - 2); x <= std::min(255, texel.cell.x + 2); ++x) {
          const std::uint32_t other = atlas.texel_in({x, y});
          if (other == kNoTexel) continue;
          ASSERT_EQ(atlas.texels()[other].chart, texel.chart);
        }
      }
    }
  }
}

TEST(TexelAtlas, ConnectedTrianglesShareCharts) {
  const SceneBuilder builder = mixed_scene();
  const Built single(builder.scene, settings_for(ChartKind::triangle, 256));
  const Built joined(builder.scene, settings_for(ChartKind::connected, 256));
  EXPECT_EQ(single.atlas.charts().size(), builder.scene.face_count());
  // A quad of the box is one chart, a sphere a few.
  EXPECT_LT(joined.atlas.charts().size(), 6U + 2U * 50U);
  EXPECT_GT(joined.atlas.layout().texels_per_m, 1.2 * single.atlas.layout().texels_per_m);
  for (std::uint32_t object = 0; object < 6; ++object) {
    EXPECT_EQ(joined.atlas.chart_of(object, 0), joined.atlas.chart_of(object, 1));
  }
}

TEST(TexelAtlas, DensityIsAParameter) {
  SceneBuilder builder;
  const int wall = builder.add_material(test::lambert(glm::vec3(0.5F)));
  builder.add_quad({0, 0, 0}, {2, 0, 0}, {0, 1, 0}, wall);
  const Built built(builder.scene, settings_for(ChartKind::connected, 256, 50.0));
  ASSERT_EQ(built.atlas.texels().size(), 100U * 50U);
  for (const Texel& texel : built.atlas.texels()) EXPECT_NEAR(texel.area_m2, 4e-4, 1e-9);
}

TEST(TexelAtlas, SaysWhatFitsIfTheSceneDoesNot) {
  SceneBuilder builder;
  builder.scene.name = "plate";
  const int wall = builder.add_material(test::lambert(glm::vec3(0.5F)));
  builder.add_quad({0, 0, 0}, {2, 0, 0}, {0, 1, 0}, wall);
  EXPECT_EQ(tests::input_error_of(
                [&] { Built(builder.scene, settings_for(ChartKind::connected, 64, 50.0)); }),
            "texel atlas: scene \"plate\" (2 m2 of charts) does not fit into 64 x 64 texels at 50 "
            "texels per metre; accepted: at most 32, or a larger atlas_side");
  EXPECT_EQ(tests::input_error_of(
                [&] { Built(mixed_scene().scene, settings_for(ChartKind::triangle, 16)); }),
            "texel atlas: 588 charts of scene \"\" do not fit into 16 x 16 texels, not even with a "
            "texel each; accepted: a larger atlas_side, or charts=connected");
}

/// Two turns of a ramp around an axis: flat enough for one chart, whose halves lie over each other.
TEST(TexelAtlas, SplitsChartsThatLieOverThemselves) {
  SceneBuilder builder;
  const int material = builder.add_material(test::lambert(glm::vec3(0.5F)));
  scene::Mesh mesh;
  constexpr unsigned kSteps = 60;
  for (unsigned i = 0; i <= kSteps; ++i) {
    const float angle = 4.0F * std::numbers::pi_v<float> * static_cast<float>(i) / kSteps;
    for (const float radius : {0.5F, 1.0F}) {
      mesh.positions.push_back(
          {radius * std::cos(angle), 0.02F * angle, -radius * std::sin(angle)});
    }
    if (i == kSteps) break;
    const unsigned a = 2 * i;
    mesh.triangles.push_back({a, a + 1, a + 3});
    mesh.triangles.push_back({a, a + 3, a + 2});
  }
  scene::Object ramp;
  ramp.mesh = std::make_shared<const scene::Mesh>(std::move(mesh));
  ramp.material = material;
  builder.scene.objects.push_back(ramp);
  const Built built(builder.scene, settings_for(ChartKind::connected, 256));
  EXPECT_EQ(built.atlas.split_charts(), 1U);
  EXPECT_EQ(built.atlas.charts().size(), 2U * kSteps);
  const double area_m2 = world_triangles(builder.scene).area_m2();
  EXPECT_NEAR(area_of_texels(built.atlas), area_m2, 1e-4 * area_m2);
}

TEST(TexelAtlas, ColorsAreMeansOverTheTexel) {
  SceneBuilder builder;
  scene::Texture stripes;
  stripes.image = perception::make_rgb_image(2, 1, perception::Encoding::scene_linear);
  stripes.image.pixels = {1.0F, 0.5F, 0.0F, 0.0F, 0.5F, 1.0F};
  builder.scene.textures.push_back(stripes);
  scene::Material material = test::lambert(glm::vec3(0.8F), glm::vec3(2.0F));
  material.albedo_texture = 0;
  material.emission_texture = 0;
  const int striped = builder.add_material(material);
  builder.add_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, striped);
  const Built built(builder.scene, settings_for(ChartKind::connected, 8, 8.0));
  glm::dvec3 albedo(0.0);
  glm::dvec3 emission(0.0);
  for (const Texel& texel : built.atlas.texels()) {
    albedo += glm::dvec3(texel.area_m2 * texel.albedo);
    emission += glm::dvec3(texel.area_m2 * texel.emission);
  }
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(albedo[channel], 0.4, 2e-3);
    EXPECT_NEAR(emission[channel], 1.0, 5e-3);
  }
}

TEST(TexelAtlas, LeavesOutDegenerateTrianglesAndTakesAnEmptyScene) {
  SceneBuilder builder;
  const int wall = builder.add_material(test::lambert(glm::vec3(0.5F)));
  builder.add_quad({0, 0, 0}, {1, 0, 0}, {1, 0, 0}, wall);
  const Built flat(builder.scene, settings_for(ChartKind::connected, 32));
  EXPECT_TRUE(flat.atlas.texels().empty());
  EXPECT_EQ(flat.atlas.texel_at(0, 0, {0.2F, 0.2F}), kNoTexel);
  const Built empty(scene::Scene{}, settings_for(ChartKind::connected, 32));
  EXPECT_TRUE(empty.atlas.texels().empty());
}

}  // namespace
}  // namespace renderers::texel_atlas
