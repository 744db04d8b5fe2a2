#include "renderers/clustered_visibility/re_emission.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "renderers/many_lights/virtual_light.h"
#include "renderers/opengl/context.h"
#include "tests/renderers/instant_radiosity/box_scenes.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::test {
namespace {

namespace cv = clustered_visibility;
using many_lights::VirtualLight;

constexpr glm::dvec3 kLuminance{0.2126, 0.7152, 0.0722};

/// A table of 2 x 1 m whose normal is +y, of a colour.
scene::Scene table(const glm::vec3& albedo) {
  SceneBuilder builder;
  builder.add_quad({0, 0, 0}, {0, 0, 1}, {2, 0, 0}, builder.add_material(lambert(albedo)));
  return builder.scene;
}

TEST(ReEmission, APointSendsOnWhatItsSidesReceive) {
  constexpr int kCount = 24;
  const glm::vec3 albedo(0.2F, 0.5F, 0.8F);
  const scene::Scene scene = table(albedo);
  const auto context = opengl::Context::create("auto");
  StageTimer timer;
  opengl::GpuScene gpu_scene(context);
  gpu_scene.load(scene, timer);
  const shadow_maps::SurfacePoints points = shadow_maps::surface_points(scene, 0, kCount);
  cv::ReEmission emission(context, kCount);
  emission.place(points, gpu_scene);

  // By thirds: front alone, back alone, both sides with three times as much in front.
  const opengl::GeometryBuffer& receivers = emission.receivers();
  const auto texels = static_cast<std::size_t>(receivers.width_px() * receivers.height_px());
  std::vector<float> irradiance(texels * 4, 0.0F);
  const glm::vec3 light(3.0F, 2.0F, 1.0F);
  for (std::size_t i = 0; i < kCount; ++i) {
    const float front = i % 3 == 1 ? 0.0F : 3.0F;
    const float back = i % 3 == 0 ? 0.0F : 1.0F;
    for (glm::length_t c = 0; c < 3; ++c) {
      irradiance[i * 4 + static_cast<std::size_t>(c)] = front * light[c];
      irradiance[(kCount + i) * 4 + static_cast<std::size_t>(c)] = back * light[c];
    }
  }
  opengl::Texture received(context, {.format = opengl::TextureFormat::rgba32f,
                                     .width_px = receivers.width_px(),
                                     .height_px = receivers.height_px()});
  received.write(irradiance);
  emission.emit(received);

  const auto lights = emission.lights().read<VirtualLight>(kCount);
  ASSERT_EQ(points.points.size(), std::size_t{kCount});
  int drawn_front = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const shadow_maps::SurfacePoint& point = points.points[i];
    const VirtualLight& got = lights[static_cast<std::size_t>(point.place)];
    const bool is_front = got.geometric_normal.y > 0.0F;
    EXPECT_EQ(glm::vec3(got.position), point.position);
    EXPECT_EQ(got.position.w, 1.0F);
    EXPECT_FLOAT_EQ(std::fabs(got.geometric_normal.y), 1.0F);
    if (i % 3 != 2) {
      EXPECT_EQ(is_front, i % 3 == 0);
    }
    if (i % 3 == 2 && is_front) ++drawn_front;
    // Phi = albedo E A / N of one side, over the probability of having drawn it.
    const double power = i % 3 == 0 ? 3.0 : i % 3 == 1 ? 1.0 : 4.0;
    const glm::dvec3 expected =
        glm::dvec3(albedo) * glm::dvec3(light) * power * 2.0 / static_cast<double>(kCount);
    EXPECT_NEAR(glm::dot(glm::dvec3(got.flux), kLuminance), glm::dot(expected, kLuminance),
                1e-6 * glm::dot(expected, kLuminance));
    EXPECT_NEAR(got.flux.x / got.flux.z, expected.x / expected.z, 1e-5);
  }
  EXPECT_GE(drawn_front, 5) << "three quarters of eight";
  EXPECT_LE(drawn_front, 7);
}

std::vector<double> flux_of(const Frame& frame) {
  for (const auto& [name, value] : frame.counters) {
    if (name == "bounce_flux_w") return std::get<std::vector<double>>(value);
  }
  return {};
}

Frame picture(const scene::Scene& scene, std::vector<std::string> more) {
  RenderRequest request;
  request.renderer = "clustered-visibility";
  request.settings = {"light_map_px=64", "area_light_map_px=32", "shadow_map_px=32",
                      "vpls=256",        "part=indirect",        "interleave=1"};
  for (std::string& setting : more) request.settings.push_back(std::move(setting));
  request.width_px = request.height_px = 24;
  request.samples = 0;
  return render(scene, request);
}

/// An empty closed box, 3 x 2 x 2.5 m, of one colour, with a point light in it.
scene::Scene empty_box(float albedo) {
  SceneBuilder builder;
  builder.add_box({0, 0, 0}, {3, 2, 2.5F}, builder.add_material(lambert(glm::vec3(albedo))), true);
  builder.add_point_light({1.2F, 1.1F, 1.4F}, glm::vec3(5.0F));
  builder.look({1.5F, 1.0F, 2.2F}, {1.5F, 0.9F, 0.0F}, 60.0F);
  return builder.scene;
}

TEST(LightBounces, AClosedBoxReflectsItsAlbedoOfTheFluxOfTheBounceBefore) {
  for (const float albedo : {0.3F, 0.8F}) {
    const std::vector<double> flux =
        flux_of(picture(empty_box(albedo), {"bounces=4", "clamp_radius=0", "visibility=oracle"}));
    ASSERT_EQ(flux.size(), 4U);
    EXPECT_NEAR(flux[0], 4.0 * 3.14159265358979 * 5.0 * albedo, 0.02 * flux[0]);
    for (std::size_t i = 1; i < flux.size(); ++i) {
      EXPECT_NEAR(flux[i] / flux[i - 1], albedo, 0.04 * albedo) << "bounce " << i + 1;
    }
  }
}

TEST(LightBounces, EachBringsThePictureNearerToThatOfAllDiffuseBounces) {
  const scene::Scene scene = spot_in_box();
  RenderRequest request;
  request.renderer = "path";
  request.settings = {"transport=diffuse", "part=indirect"};
  request.width_px = request.height_px = 24;
  request.samples = 1024;
  const Frame truth = render(scene, request);
  double before = 1e9;
  for (const char* bounces : {"bounces=1", "bounces=2", "bounces=3"}) {
    const Frame frame = picture(scene, {bounces, "visibility=hard"});
    const double error = relative_rms(frame, truth);
    EXPECT_LT(error, 0.8 * before) << bounces;
    before = error;
  }
}

TEST(LightBounces, OneBounceIsThePictureWithoutTheParameterBitForBit) {
  const scene::Scene scene = spot_in_box();
  EXPECT_EQ(picture(scene, {"bounces=1"}).radiance.pixels, picture(scene, {}).radiance.pixels);
}

TEST(LightBounces, AreTheSameBytesAgainAndBlackWithoutLight) {
  for (const char* visibility : {"visibility=cssm", "visibility=oracle"}) {
    scene::Scene scene = spot_in_box();
    const Frame once = picture(scene, {"bounces=3", visibility});
    EXPECT_EQ(once.radiance.pixels, picture(scene, {"bounces=3", visibility}).radiance.pixels);
    EXPECT_GT(mean_radiance(once), mean_radiance(picture(scene, {visibility})));
    scene.lights.clear();
    const Frame dark = picture(scene, {"bounces=3", visibility});
    EXPECT_EQ(*std::ranges::max_element(dark.radiance.pixels), 0.0F);
    EXPECT_EQ(flux_of(dark), std::vector<double>(3, 0.0));
  }
}

TEST(LightBounces, BlackSurfacesSendNothingOn) {
  const std::vector<double> flux = flux_of(picture(empty_box(0.0F), {"bounces=2"}));
  EXPECT_EQ(flux, std::vector<double>(2, 0.0));
}

TEST(LightBounces, GrowWithTheNumberOfClustersFound) {
  const Frame grown = picture(spot_in_box(), {"bounces=2", "adaptive=true", "vals=64"});
  const auto maps = static_cast<int>(counter(grown, "shadow_maps"));
  const Frame fixed = picture(spot_in_box(), {"bounces=2", "vals=" + std::to_string(maps / 2)});
  EXPECT_EQ(grown.radiance.pixels, fixed.radiance.pixels);
}

}  // namespace
}  // namespace renderers::test
