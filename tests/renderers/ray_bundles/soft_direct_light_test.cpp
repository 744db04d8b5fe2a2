#include "renderers/ray_bundles/soft_direct_light.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "renderers/contract/devices.h"
#include "renderers/ray_bundles/atlas_lights.h"
#include "tests/expect_input_error.h"
#include "tests/renderers/ray_bundles/bundle_fixture.h"

/// Direct light by percentage-closer soft shadows, bundles for the rest (Hermes et al. 2010, Fig.
/// 11).
namespace renderers::test {
namespace {

using ray_bundles::AtlasLightSettings;
using ray_bundles::SoftDirectLight;

constexpr float kLampHeight_m = 2.0F;
constexpr float kEdgeHeight_m = 0.5F;

/// A floor under a square lamp, and between them a half plane over x < 0, or nothing.
SceneBuilder half_plane(float lamp_m, bool has_plane) {
  SceneBuilder builder;
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
  const int white = builder.add_material(lambert(glm::vec3(0.8F)));
  const float half_m = 0.5F * lamp_m;
  builder.add_quad({-half_m, kLampHeight_m, -half_m}, {lamp_m, 0, 0}, {0, 0, lamp_m}, lamp);
  builder.add_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, white);
  if (has_plane) {
    builder.add_quad({-4, kEdgeHeight_m, -4}, {0, 0, 8}, {4, 0, 0}, white);
  }
  return builder;
}

/// Radiance of the floor at places along x, z = 0.
std::vector<double> floor_radiance(const SceneBuilder& builder, const std::vector<double>& x_m) {
  StageTimer timer;
  const ray_tracing::RayScene rays(builder.scene, timer);
  ray_bundles::SoftLightSettings settings;
  settings.shadows.map_px = 2048;
  settings.shadows.search_side = 16;
  settings.shadows.filter_side = 32;
  const SoftDirectLight soft(rays, settings);
  std::vector<double> radiance;
  for (const double x : x_m) {
    ray_tracing::Hit hit;
    const glm::vec3 down(0.0F, -1.0F, 0.0F);
    EXPECT_TRUE(rays.intersect({{static_cast<float>(x), 0.1F, 0.0F}, down}, hit));
    const auto brdf = make_brdf(builder.scene, hit, -down, ray_tracing::Lobes::all);
    radiance.push_back(static_cast<double>(soft.reflected(hit, brdf).x));
  }
  return radiance;
}

/// What share of the lamp lights the places.
std::vector<double> visible_shares(float lamp_m, const std::vector<double>& x_m) {
  const std::vector<double> open = floor_radiance(half_plane(lamp_m, false), x_m);
  std::vector<double> shares = floor_radiance(half_plane(lamp_m, true), x_m);
  for (std::size_t i = 0; i < shares.size(); ++i) shares[i] /= open[i];
  return shares;
}

std::vector<double> places() {
  std::vector<double> x_m;
  for (int i = -150; i < 150; ++i) x_m.push_back(0.002 * (i + 0.5));
  return x_m;
}

/// Radiance of the open floor below the middle of the lamp: albedo times the form factor of a
/// square seen from a point, by Lambert's polygon.
TEST(SoftDirectLight, HasTheLampsLightWhereNothingHidesIt) {
  const double half = 0.3;
  const double height = static_cast<double>(kLampHeight_m);
  const double expected = 0.8 * lambert_polygon({{-half, height, -half},
                                                 {half, height, -half},
                                                 {half, height, half},
                                                 {-half, height, half}},
                                                {0.05, 0, 0}, {0, 1, 0});
  EXPECT_NEAR(floor_radiance(half_plane(0.6F, false), {0.05})[0], expected, 2e-3 * expected);
}

/// Behind an edge at height h the penumbra of a lamp of width w at height H is w h / (H - h) wide,
/// and the visible share rises linearly over it.
TEST(SoftDirectLight, PenumbraeHaveTheirWidth) {
  const std::vector<double> x_m = places();
  for (const float lamp_m : {0.3F, 0.6F}) {
    const double width_m =
        static_cast<double>(lamp_m * kEdgeHeight_m / (kLampHeight_m - kEdgeHeight_m));
    const std::vector<double> shares = visible_shares(lamp_m, x_m);
    const auto crossing_m = [&](double share) {
      const auto first =
          std::find_if(shares.begin(), shares.end(), [&](double value) { return value >= share; });
      return x_m[static_cast<std::size_t>(first - shares.begin())];
    };
    EXPECT_NEAR((crossing_m(0.9) - crossing_m(0.1)) / 0.8, width_m, 0.1 * width_m) << lamp_m;
    EXPECT_NEAR(crossing_m(0.5), 0.0, 0.05 * width_m) << lamp_m;
    for (std::size_t i = 0; i < x_m.size(); ++i) {
      EXPECT_NEAR(shares[i], std::clamp(0.5 + x_m[i] / width_m, 0.0, 1.0), 0.08) << x_m[i];
    }
  }
}

/// A lamp of a centimetre casts a hard shadow.
TEST(SoftDirectLight, SmallLampsCastHardShadows) {
  const std::vector<double> x_m = places();
  const std::vector<double> shares = visible_shares(0.01F, x_m);
  for (std::size_t i = 0; i < x_m.size(); ++i) {
    if (std::fabs(x_m[i]) < 0.005) continue;
    EXPECT_EQ(shares[i], x_m[i] > 0.0 ? 1.0 : 0.0) << x_m[i];
  }
}

/// Texels take the same light as their points.
TEST(SoftDirectLight, LightsTheAtlas) {
  const SceneBuilder builder = half_plane(0.6F, true);
  const BundleScene built(builder.scene, 64);
  const SoftDirectLight soft(built.rays, {});
  AtlasLightSettings settings;
  settings.soft = &soft;
  const auto light = light_atlas(built.rays, built.atlas, settings);
  int lit = 0;
  for (std::uint32_t i = 0; i < built.atlas.texels().size(); ++i) {
    const ray_tracing::SurfacePoint& point = built.atlas.texels()[i].point;
    if (point.object != 1) continue;
    const auto brdf =
        make_brdf(builder.scene, point, point.geometric_normal, ray_tracing::Lobes::all);
    const glm::vec3 reflected = soft.reflected(point, brdf);
    EXPECT_NEAR(0.8F * light.incident[2 * i].x, reflected.x, 1e-6F);
    EXPECT_EQ(light.incident[2 * i + 1].x, 0.0F);
    lit += reflected.x > 0.0F ? 1 : 0;
  }
  EXPECT_GT(lit, 10);
}

/// A room with a block and a lamp in its ceiling.
SceneBuilder room() {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.6F, 0.5F, 0.4F)));
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(5.0F)));
  add_closed_box(builder, glm::vec3(-1.0F), glm::vec3(1.0F), white, true);
  builder.add_quad({-0.2F, 0.98F, -0.2F}, {0.4F, 0, 0}, {0, 0, 0.4F}, lamp);
  builder.add_box({0.0F, -0.9F, 0.1F}, {0.5F, -0.3F, 0.6F}, white, false);
  builder.add_point_light({-0.5F, 0.3F, -0.2F}, glm::vec3(0.2F));
  builder.look({0.1F, 0.0F, -0.95F}, {0, -0.1F, 1}, 75.0F);
  return builder;
}

Frame picture(const SceneBuilder& builder, std::vector<std::string> settings) {
  settings.insert(settings.end(), {"atlas_side=96", "lines=96", "pass_directions=64"});
  return render(builder.scene, {.renderer = "ray-bundles",
                                .settings = std::move(settings),
                                .width_px = 32,
                                .height_px = 32,
                                .samples = 256});
}

/// The light that bundles make of it is right to 3 %, the direct light but for its penumbrae; the
/// lamp is in the picture once.
TEST(SoftDirectLight, BundlesCarryTheRest) {
  const SceneBuilder builder = room();
  const Frame truth =
      render(builder.scene,
             {.settings = {"transport=diffuse"}, .width_px = 32, .height_px = 32, .samples = 256});
  const Frame soft = picture(builder, {"direct=pcss"});
  const double indirect = mean_of(aov(truth, "indirect"));
  EXPECT_NEAR(mean_of(aov(soft, "indirect")), indirect, 0.03 * indirect);
  const double direct = mean_of(aov(truth, "direct"));
  EXPECT_NEAR(mean_of(aov(soft, "direct")), direct, 0.03 * direct);
  EXPECT_GT(direct, 0.3 * mean_of(truth.radiance));
  EXPECT_NE(soft.radiance.pixels, picture(builder, {}).radiance.pixels);
}

/// The lobe that the camera sees reflects the lamp's light, too.
TEST(SoftDirectLight, LobesSeeTheLamp) {
  SceneBuilder builder = room();
  builder.scene.materials[0] = phong(glm::vec3(0.3F), glm::vec3(0.4F), 8.0F);
  const Frame truth =
      render(builder.scene,
             {.settings = {"transport=diffuse"}, .width_px = 32, .height_px = 32, .samples = 256});
  const double direct = mean_of(aov(truth, "direct"));
  const Frame soft = picture(builder, {"direct=pcss", "camera_rays=8"});
  EXPECT_NEAR(mean_of(aov(soft, "direct")), direct, 0.03 * direct);
}

TEST(SoftDirectLight, RefusesLightsWithoutAMiddle) {
  SceneBuilder sky = room();
  sky.set_environment(glm::vec3(0.5F));
  EXPECT_THROW(picture(sky, {"direct=pcss"}), UnsupportedError);
  SceneBuilder ball = room();
  ball.add_sphere({0, 0, 0}, 0.1F, 8, 1);
  EXPECT_THROW(picture(ball, {"direct=pcss"}), UnsupportedError);
  EXPECT_EQ(tests::input_error_of([&] {
              picture(room(), {"direct=pcss", "light_points=12"});
            }),
            "ray-bundles: light_points is 12; accepted: a power of two from 4 to 256");
}

}  // namespace
}  // namespace renderers::test
