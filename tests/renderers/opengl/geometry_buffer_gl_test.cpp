#include "renderers/opengl/geometry_buffer.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec4.hpp>

#include "renderers/contract/stage_timer.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "tests/renderers/opengl/platform_test.h"
#include "tests/renderers/opengl/surface_oracle.h"

namespace renderers::opengl {
namespace {

/// The four textures of a geometry buffer on the CPU.
struct Picture {
  explicit Picture(const GeometryBuffer& buffer)
      : size_px(buffer.width_px(), buffer.height_px()),
        position(buffer.position().read()),
        geometric_normal(buffer.geometric_normal().read()),
        shading_normal(buffer.shading_normal().read()),
        albedo(buffer.albedo().read()) {}

  glm::vec4 texel(const std::vector<float>& values, int x, int y) const {
    const std::size_t i = 4 * static_cast<std::size_t>(y * size_px.x + x);
    return {values[i], values[i + 1], values[i + 2], values[i + 3]};
  }

  glm::ivec2 size_px;
  std::vector<float> position;
  std::vector<float> geometric_normal;
  std::vector<float> shading_normal;
  std::vector<float> albedo;
};

/// Largest differences to the oracle over the pixels away from edges.
struct Differences {
  double position = 0.0;  ///< relative to the distance from the view's origin
  double geometric_normal = 0.0;
  double shading_normal = 0.0;
  double albedo = 0.0;
  int compared = 0;
  int wrong_kind = 0;  ///< surface where there is none, other material, or the other way round
};

/// The surface at a pixel's centre, if the rays around it meet the same triangle or all nothing.
struct PixelOracle {
  bool is_at_edge = false;
  std::optional<OracleSurface> surface;
};

PixelOracle oracle_of(const ray_tracing::RayScene& scene, const View& view,
                      const glm::ivec2& size_px, const glm::ivec2& pixel) {
  constexpr double kEdge_px = 0.05;
  const glm::dvec2 center = glm::dvec2(pixel) + 0.5;
  PixelOracle oracle;
  oracle.surface = surface_along(scene, ray_of(view, size_px, center));
  for (const glm::dvec2& offset :
       {glm::dvec2(1, 1), glm::dvec2(1, -1), glm::dvec2(-1, 1), glm::dvec2(-1, -1)}) {
    const auto near = surface_along(scene, ray_of(view, size_px, center + kEdge_px * offset));
    oracle.is_at_edge = oracle.is_at_edge || near.has_value() != oracle.surface.has_value() ||
                        (near && (near->object != oracle.surface->object ||
                                  near->triangle != oracle.surface->triangle));
  }
  return oracle;
}

void add_difference(const OracleSurface& expected, const Picture& picture, const glm::ivec2& pixel,
                    Differences& sum) {
  const auto difference = [&](const std::vector<float>& values, const glm::dvec3& value) {
    return glm::length(glm::dvec3(glm::vec3(picture.texel(values, pixel.x, pixel.y))) - value);
  };
  sum.position =
      std::max(sum.position, difference(picture.position, expected.position) / expected.distance_m);
  sum.geometric_normal = std::max(sum.geometric_normal,
                                  difference(picture.geometric_normal, expected.geometric_normal));
  sum.shading_normal =
      std::max(sum.shading_normal, difference(picture.shading_normal, expected.shading_normal));
  sum.albedo = std::max(sum.albedo, difference(picture.albedo, glm::dvec3(expected.albedo)));
  const float material = picture.texel(picture.geometric_normal, pixel.x, pixel.y).w;
  const float glossy = picture.texel(picture.albedo, pixel.x, pixel.y).w;
  const float shading_w = picture.texel(picture.shading_normal, pixel.x, pixel.y).w;
  if (material != static_cast<float>(expected.material) ||
      glossy != (expected.is_glossy ? 1.0F : 0.0F) || shading_w != 0.0F) {
    ++sum.wrong_kind;
  }
}

bool is_background(const Picture& picture, int x, int y) {
  const glm::vec4 nothing(0.0F);
  return picture.texel(picture.position, x, y) == nothing &&
         picture.texel(picture.geometric_normal, x, y) == nothing &&
         picture.texel(picture.shading_normal, x, y) == nothing &&
         picture.texel(picture.albedo, x, y) == nothing;
}

Differences differences_of(const Picture& picture, const ray_tracing::RayScene& scene,
                           const View& view) {
  Differences sum;
  for (int y = 0; y < picture.size_px.y; ++y) {
    for (int x = 0; x < picture.size_px.x; ++x) {
      const PixelOracle oracle = oracle_of(scene, view, picture.size_px, {x, y});
      if (oracle.is_at_edge) continue;
      ++sum.compared;
      const bool is_surface = picture.texel(picture.position, x, y).w == 1.0F;
      if (is_surface != oracle.surface.has_value() ||
          (!is_surface && !is_background(picture, x, y))) {
        ++sum.wrong_kind;
        continue;
      }
      if (oracle.surface) add_difference(*oracle.surface, picture, {x, y}, sum);
    }
  }
  return sum;
}

class GeometryBufferGlTest : public PlatformTest {
 protected:
  GeometryBufferGlTest() : scene_(surface_scene()), ray_scene_(scene_, timer_) {}

  Picture draw(const View& view, const glm::ivec2& size_px) {
    GpuScene gpu_scene(context_);
    gpu_scene.load(scene_, timer_);
    GeometryBuffer buffer(context_, size_px.x, size_px.y);
    buffer.render(gpu_scene, view);
    return Picture(buffer);
  }

  /// Draws the scene and compares it with the oracle.
  void expect_oracle(const View& view, const glm::ivec2& size_px) {
    const Differences result = differences_of(draw(view, size_px), ray_scene_, view);
    EXPECT_EQ(result.wrong_kind, 0);
    EXPECT_GT(result.compared, 0.85 * size_px.x * size_px.y);
    EXPECT_LT(result.position, 1e-5);
    EXPECT_LT(result.geometric_normal, 1e-6);
    EXPECT_LT(result.shading_normal, 2e-5);
    EXPECT_LT(result.albedo, 5e-4);
    RecordProperty("position", fmt::format("{:.2e}", result.position));
    RecordProperty("geometric_normal", fmt::format("{:.2e}", result.geometric_normal));
    RecordProperty("shading_normal", fmt::format("{:.2e}", result.shading_normal));
    RecordProperty("albedo", fmt::format("{:.2e}", result.albedo));
  }

  StageTimer timer_;
  scene::Scene scene_;
  ray_tracing::RayScene ray_scene_;
};
INSTANTIATE_TEST_SUITE_P(Platforms, GeometryBufferGlTest, all_platforms(), platform_label);

TEST_P(GeometryBufferGlTest, HoldsWhatRaysMeet) {
  expect_oracle(camera_view(scene_.camera, 161, 119), {161, 119});
}

TEST_P(GeometryBufferGlTest, HoldsWhatMovedRaysMeet) {
  expect_oracle(camera_view(scene_.camera, 75, 121, {0.37F, -0.21F}), {75, 121});
}

/// The comparison sees a hundredth of a pixel.
TEST_P(GeometryBufferGlTest, DiffersFromOtherRays) {
  const glm::ivec2 size_px(75, 51);
  const Picture picture = draw(camera_view(scene_.camera, 75, 51), size_px);
  const View moved = camera_view(scene_.camera, 75, 51, {0.01F, 0.0F});
  EXPECT_GT(differences_of(picture, ray_scene_, moved).position, 1e-4);
}

/// From outside with a narrow view: background, and single-sided walls seen from behind.
TEST_P(GeometryBufferGlTest, HoldsBackSidesAndBackground) {
  scene_.camera = {{30.0F, 25.0F, 40.0F}, {0.0F, 2.0F, 0.0F}, {0, 1, 0}, 20.0F};
  expect_oracle(camera_view(scene_.camera, 95, 77), {95, 77});
}

TEST_P(GeometryBufferGlTest, HoldsWhatParallelRaysMeet) {
  View view = camera_view(scene_.camera, 101, 67);
  view.origin = {0.3F, 4.9F, 0.2F};
  view.forward = glm::normalize(glm::vec3(0.2F, -1.0F, 0.1F));
  view.right = glm::normalize(glm::cross(view.forward, glm::vec3(0, 0, 1)));
  view.up = glm::cross(view.right, view.forward);
  view.is_orthographic = true;
  view.half_width = 5.0F;
  view.half_height = 3.5F;
  view.center = {0.4F, -0.2F};
  expect_oracle(view, {101, 67});
}

TEST_P(GeometryBufferGlTest, HoldsWhatTheFacesOfACubeMeet) {
  const glm::vec3 forward = glm::normalize(glm::vec3(0.3F, -0.9F, 0.2F));
  const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0, 0, 1), forward));
  const glm::mat3 axes(right, glm::cross(forward, right), forward);
  for (int face = 0; face < 6; ++face) {
    SCOPED_TRACE(face);
    expect_oracle(cube_face({0.2F, 3.1F, 0.3F}, axes, face), {33, 33});
  }
}

TEST_P(GeometryBufferGlTest, OfAnEmptySceneIsEmpty) {
  GpuScene gpu_scene(context_);
  gpu_scene.load(scene::Scene{}, timer_);
  EXPECT_EQ(gpu_scene.triangle_count(), 0);
  GeometryBuffer buffer(context_, 9, 5);
  buffer.render(gpu_scene, View{});
  const Picture picture(buffer);
  for (int i = 0; i < 45; ++i) EXPECT_TRUE(is_background(picture, i % 9, i / 9));
}

/// A second picture shows nothing of the first.
TEST_P(GeometryBufferGlTest, DrawsEachPictureAnew) {
  GpuScene gpu_scene(context_);
  gpu_scene.load(scene_, timer_);
  GeometryBuffer buffer(context_, 40, 30);
  const View view = camera_view(scene_.camera, 40, 30);
  buffer.render(gpu_scene, view);
  const std::vector<float> first = buffer.position().read();
  View away = view;
  away.origin = {0.0F, 50.0F, 0.0F};
  away.forward = {0.0F, 1.0F, 0.0F};
  away.right = {1.0F, 0.0F, 0.0F};
  away.up = {0.0F, 0.0F, 1.0F};
  buffer.render(gpu_scene, away);
  EXPECT_EQ(buffer.position().read(), std::vector<float>(first.size(), 0.0F));
  buffer.render(gpu_scene, view);
  EXPECT_EQ(buffer.position().read(), first);
}

/// Between the values of two pictures.
double largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, std::fabs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
  }
  return largest;
}

/// Both platforms run the same rasteriser of Mesa.
TEST(GeometryBuffers, AreEqualOnBothPlatforms) {
  const scene::Scene scene = surface_scene();
  std::vector<Picture> pictures;
  for (const char* platform : {"egl-surfaceless", "osmesa"}) {
    const auto context = Context::create(platform);
    StageTimer timer;
    GpuScene gpu_scene(context);
    gpu_scene.load(scene, timer);
    GeometryBuffer buffer(context, 161, 119);
    buffer.render(gpu_scene, camera_view(scene.camera, 161, 119));
    pictures.emplace_back(buffer);
  }
  const double position = largest_difference(pictures[0].position, pictures[1].position);
  const double normal = largest_difference(pictures[0].shading_normal, pictures[1].shading_normal);
  const double albedo = largest_difference(pictures[0].albedo, pictures[1].albedo);
  EXPECT_LT(position, 1e-6);
  EXPECT_LT(normal, 1e-6);
  EXPECT_LT(albedo, 1e-6);
  RecordProperty("position_m", fmt::format("{:.2e}", position));
  RecordProperty("shading_normal", fmt::format("{:.2e}", normal));
  RecordProperty("albedo", fmt::format("{:.2e}", albedo));
}

}  // namespace
}  // namespace renderers::opengl
