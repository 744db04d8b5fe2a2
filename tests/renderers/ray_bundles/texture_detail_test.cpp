#include "renderers/ray_bundles/texture_detail.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "renderers/ray_tracing/surface_brdf.h"
#include "tests/renderers/ray_bundles/bundle_fixture.h"

/// Textures finer than the atlas, as bundles see them.
namespace renderers::test {
namespace {

using ray_bundles::ListKind;
using ray_bundles::TransferMode;
using ray_bundles::TransportSettings;

/// An image that changes all over. @param side_px  of the square
scene::Texture uneven_texture(int side_px) {
  scene::Texture texture;
  texture.image = perception::make_rgb_image(side_px, side_px, perception::Encoding::scene_linear);
  for (std::size_t i = 0; i < texture.image.pixels.size(); ++i) {
    texture.image.pixels[i] = 0.1F + 0.8F * static_cast<float>((7 * i * i + 3 * i) % 11) / 11.0F;
  }
  return texture;
}

/// White on the left half (u < 1/2), black on the right.
scene::Texture half_texture() {
  constexpr int kSide = 64;
  scene::Texture texture;
  texture.image = perception::make_rgb_image(kSide, 1, perception::Encoding::scene_linear);
  for (std::size_t x = 0; x < kSide; ++x) {
    std::fill_n(texture.image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * x), 3,
                x < kSide / 2 ? 1.0F : 0.0F);
  }
  return texture;
}

/// A bent sheet of `cells` quads along its arc, with texture coordinates.
int add_bent_sheet(SceneBuilder& builder, int cells, int material) {
  scene::Mesh mesh;
  for (int i = 0; i <= cells; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(cells);
    const float angle = 2.5F * share;
    for (const float y : {0.0F, 1.0F}) {
      mesh.positions.push_back({std::cos(angle), y, std::sin(angle)});
      mesh.uvs.push_back({share, y});
    }
  }
  for (unsigned i = 0; i < static_cast<unsigned>(cells); ++i) {
    mesh.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 3});
    mesh.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 2});
  }
  scene::Object object;
  object.mesh = std::make_shared<const scene::Mesh>(std::move(mesh));
  object.material = material;
  builder.scene.objects.push_back(std::move(object));
  return static_cast<int>(builder.scene.objects.size()) - 1;
}

/// Every point of every triangle has the colours that its material has there, whichever texel it
/// lies in and however many triangles share that.
TEST(TextureDetail, IsTheMaterialAtThePoint) {
  SceneBuilder builder;
  builder.scene.textures.push_back(uneven_texture(8));
  scene::Material cloth = lambert(glm::vec3(0.9F, 0.7F, 0.5F), glm::vec3(2.0F, 1.0F, 3.0F));
  cloth.albedo_texture = 0;
  cloth.emission_texture = 0;
  const int plain = builder.add_material(lambert(glm::vec3(0.5F), glm::vec3(1.0F)));
  add_bent_sheet(builder, 40, builder.add_material(cloth));
  builder.add_quad({-1, 0, -1}, {2, 0, 0}, {0, 0, 0.5F}, plain);
  for (const int atlas_side_px : {16, 64}) {
    const BundleScene built(builder.scene, atlas_side_px);
    const ray_bundles::TextureDetail detail(built.rays, built.atlas);
    ASSERT_FALSE(detail.is_empty());
    std::mt19937 random(3);
    std::uniform_real_distribution<float> number;
    for (std::uint32_t triangle = 0; triangle < 80; ++triangle) {
      glm::vec2 at(number(random), number(random));
      if (at.x + at.y > 1.0F) at = 1.0F - at;
      const ray_tracing::SurfacePoint point = built.rays.point_on_triangle(0, triangle, at);
      const std::uint32_t texel = built.atlas.texel_at(0, triangle, at);
      const auto colors = detail.at(texel, point.position);
      ASSERT_TRUE(colors);
      const glm::vec3 emission = ray_tracing::unshaped_emission(built.rays.scene(), point);
      const glm::vec3 albedo = ray_tracing::diffuse_albedo(built.rays.scene(), point);
      EXPECT_LT(glm::distance(colors->emission, emission), 1e-3F);
      EXPECT_LT(glm::distance(colors->albedo_ratio * built.atlas.texels()[texel].albedo, albedo),
                1e-3F);
    }
    EXPECT_FALSE(detail.at(built.atlas.texel_at(1, 0, {0.3F, 0.3F}), glm::vec3(0.0F)));
  }
}

TEST(TextureDetail, IsEmptyWithoutTextures) {
  SceneBuilder builder;
  builder.add_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0},
                   builder.add_material(lambert(glm::vec3(0.5F), glm::vec3(1.0F))));
  const BundleScene built(builder.scene, 16);
  EXPECT_TRUE(ray_bundles::TextureDetail(built.rays, built.atlas).is_empty());
}

constexpr float kGap_m = 0.25F;
constexpr int kAtlasSide_px = 4;

/// A unit square of one texel at y = 0, bright on its half z < 1/2, and above that half a receiver.
/// @param emits  the bright half shines with radiance 1, or it reflects all
SceneBuilder half_bright(bool emits) {
  SceneBuilder builder;
  builder.scene.textures.push_back(half_texture());
  scene::Material source =
      emits ? lambert(glm::vec3(0.0F), glm::vec3(1.0F)) : lambert(glm::vec3(1.0F));
  (emits ? source.emission_texture : source.albedo_texture) = 0;
  builder.add_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, builder.add_material(source));
  builder.add_quad({0, kGap_m, 0}, {1, 0, 0}, {0, 0, 0.5F},
                   builder.add_material(lambert(glm::vec3(0.5F))));
  return builder;
}

/// Form factor between two parallel rectangles 1 x 1/2 right above each other, by the closed form:
/// Howell, A Catalog of Radiation Heat Transfer Configuration Factors, C-11 (recalled).
double opposed_form_factor(double width_m, double depth_m, double gap_m) {
  const double x = width_m / gap_m;
  const double y = depth_m / gap_m;
  const double xx = std::sqrt(1.0 + x * x);
  const double yy = std::sqrt(1.0 + y * y);
  return 2.0 / (std::numbers::pi * x * y) *
         (std::log(xx * yy / std::sqrt(1.0 + x * x + y * y)) + x * yy * std::atan(x / yy) +
          y * xx * std::atan(y / xx) - x * std::atan(x) - y * std::atan(y));
}

/// J on the receiver by the closed forms, of its whole area or at the points of its texels.
double expected_received(TransferMode mode) {
  if (mode == TransferMode::scatter)
    return opposed_form_factor(1.0, 0.5, static_cast<double>(kGap_m));
  const std::vector<glm::dvec3> bright{{0, 0, 0}, {0, 0, 0.5}, {1, 0, 0.5}, {1, 0, 0}};
  const SceneBuilder builder = half_bright(true);
  const BundleScene built(builder.scene, kAtlasSide_px);
  double sum = 0.0;
  double count = 0.0;
  for (const texel_atlas::Texel& texel : built.atlas.texels()) {
    if (texel.point.object != 1) continue;
    sum += lambert_polygon(bright, glm::dvec3(texel.point.position), {0, -1, 0});
    count += 1.0;
  }
  return sum / count;
}

/// J on the receiver: what the bright half sends. @param emits  bundles carry emission, or the
/// square is lit with J = 1 beforehand and reflects
double mean_received(bool emits, TransportSettings settings) {
  const SceneBuilder builder = half_bright(emits);
  BundleScene built(builder.scene, kAtlasSide_px);
  settings.lines_across = 64;
  settings.planned = 1000;
  settings.solution.carries_emission = emits;
  // One bounce alone: nothing comes back.
  settings.solution.feed = ray_bundles::FeedKind::jacobi;
  settings.solution.bounce_directions = emits ? 2000 : 1000;
  ray_bundles::BundleTransport transport(built.rays, built.atlas, settings, built.timer);
  if (!emits) {
    std::vector<glm::vec3> lit(2 * built.atlas.texels().size(), glm::vec3(0.0F));
    for (std::uint32_t i = 0; i < built.atlas.texels().size(); ++i) {
      if (built.atlas.texels()[i].point.object == 0) lit[2 * i] = glm::vec3(1.0F);
    }
    transport.set_known_direct(std::move(lit));
  }
  for (int i = 0; i < 1000; ++i) transport.add_direction(built.timer);
  return light_on(built, transport.solution(), emits ? LightOf::direct : LightOf::indirect, 1)
      .mean.x;
}

/// Texels as large as the pattern: at points its halves are where they are, by means the light
/// comes from all of the square, half as bright, and too little of it meets what is above one half.
TEST(TextureDetail, PatternsFinerThanTexelsLightWhatIsAboveThem) {
  ASSERT_NEAR(opposed_form_factor(1.0, 1.0, 1.0), 0.19982, 1e-5);
  for (const bool emits : {true, false}) {
    for (const TransferMode mode : {TransferMode::gather, TransferMode::scatter}) {
      for (const ListKind lists : {ListKind::raster, ListKind::fixed_k, ListKind::trace}) {
        TransportSettings settings;
        settings.mode = mode;
        settings.lists = lists;
        const double expected = expected_received(mode);
        EXPECT_NEAR(mean_received(emits, settings), expected, 0.01 * expected)
            << emits << (mode == TransferMode::gather ? " gather " : " scatter ")
            << static_cast<int>(lists);
        settings.textures_at_points = false;
        EXPECT_LT(mean_received(emits, settings), 0.85 * expected);
      }
    }
  }
}

/// What the camera sees is the texture at its pixels: in white light from everywhere a surface has
/// the radiance of its albedo, black next to white; the atlas' texels are five pixels wide.
TEST(TextureDetail, TheCameraSeesTexturesAtItsPixels) {
  SceneBuilder builder;
  builder.scene.textures.push_back(half_texture());
  scene::Material cloth = lambert(glm::vec3(1.0F));
  cloth.albedo_texture = 0;
  builder.add_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, builder.add_material(cloth));
  builder.set_environment(glm::vec3(1.0F));
  builder.look({0.5F, 2.0F, 0.499F}, {0.5F, 0.0F, 0.5F}, 20.0F);
  const Frame frame = render(
      builder.scene, {.renderer = "ray-bundles",
                      .settings = {"atlas_side=8", "lines=16", "direct=bundles", "camera_rays=16"},
                      .samples = 64});
  int black = 0;
  int white = 0;
  for (const float value : frame.radiance.pixels) {
    black += value == 0.0F ? 1 : 0;
    white += std::fabs(value - 1.0F) < 1e-4F ? 1 : 0;
  }
  // All but the two columns beside the border.
  const auto values = static_cast<int>(frame.radiance.pixels.size());
  EXPECT_GE(black, 7 * values / 16);
  EXPECT_GE(white, 7 * values / 16);
}

}  // namespace
}  // namespace renderers::test
