#include "renderers/scene/light_reader.h"

#include "perception/image_file.h"
#include "tests/expect_input_error.h"
#include "tests/renderers/scene/scene_text.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

namespace renderers::scene {
namespace {

Light light_of(const std::string& text) {
  const base::Node node = base::parse_document(text, "l.yaml");
  return read_light({"key", {&node, {}}}).keys[0].value;
}

std::string with_cone(const std::string& cone) {
  return "{name: key, type: spot, position: [2.8, 5, 2.8], direction: [0, -3, 0], intensity: [80, "
         "70, 60], cone_deg: " +
         cone + "}";
}

TEST(Light, SpotAnglesAreHalfAngles) {
  const Light light = light_of(with_cone("[30, 35]"));
  EXPECT_EQ(light.type, LightType::spot);
  EXPECT_EQ(light.position, glm::vec3(2.8F, 5.0F, 2.8F));
  EXPECT_EQ(light.direction, glm::vec3(0.0F, -1.0F, 0.0F));
  EXPECT_EQ(light.intensity, glm::vec3(80.0F, 70.0F, 60.0F));
  EXPECT_FLOAT_EQ(light.inner_cone_rad, std::numbers::pi_v<float> / 6.0F);
  EXPECT_FLOAT_EQ(light.outer_cone_rad, 35.0F * std::numbers::pi_v<float> / 180.0F);
}

TEST(Light, ConeMustOpenOutwards) {
  for (const char* cone : {"[35, 30]", "[-1, 30]", "[30, 91]", "[0, 0]"}) {
    EXPECT_NE(tests::input_error_of([&] { light_of(with_cone(cone)); }), "no error") << cone;
  }
  EXPECT_EQ(
      tests::input_error_of([] { light_of(with_cone("[35, 30]")); }),
      "l.yaml:1:108: cone_deg [35, 30]: half angles [inner, outer] must satisfy 0 <= inner <= "
      "outer <= 90, outer > 0");
}

TEST(Light, PointHasNoCone) {
  EXPECT_EQ(light_of("{name: key, type: point, position: [0, 1, 0], intensity: 5}").intensity,
            glm::vec3(5.0F));
  EXPECT_NE(tests::input_error_of([] {
              light_of(
                  "{name: key, type: point, position: [0, 1, 0], intensity: 5, cone_deg: [1, "
                  "2]}");
            }),
            "no error");
}

TEST(Light, BadTypeAndIntensityAreRefused) {
  EXPECT_EQ(
      tests::input_error_of([] { light_of("{name: key, type: spots}"); }),
      "l.yaml:1:19: unknown type of light \"spots\"; did you mean \"spot\"? known: point, spot");
  EXPECT_EQ(tests::input_error_of(
                [] { light_of("{name: key, type: point, position: [0, 1, 0], intensity: -5}"); }),
            "l.yaml:1:58: intensity -5 is negative; give values >= 0");
}

TEST(EnvironmentReader, ConstantIsOnePixel) {
  const base::Node node =
      base::parse_document("{constant: [1, 2, 3], scale: 2, rotate_deg: 180}", "e.yaml");
  const auto environment = read_environment({&node, {}});
  EXPECT_EQ(sample_environment(*environment, {0.0F, 1.0F, 0.0F}), glm::vec3(2, 4, 6));
  EXPECT_EQ(sample_environment(*environment, {0.6F, 0.0F, 0.8F}), glm::vec3(2, 4, 6));
  EXPECT_EQ(read_environment({}), nullptr);
}

/// A surface that faces the sun has its irradiance, whatever its size; the rest of the sky is even.
TEST(EnvironmentReader, ASunHasItsIrradiance) {
  struct Case {
    glm::vec3 towards;
    double radius_deg;
  };
  // In the zenith, beside it and below, where the map's pixels are narrow, and at the seam.
  for (const Case& one : {Case{{3, 4, 0}, 0.5}, Case{{3, 4, 0}, 20}, Case{{0, 1, 0}, 0.5},
                          Case{{0, -1, 0}, 1}, Case{{0.0175F, 1, 0}, 1}, Case{{-1, 0, 0}, 45}}) {
    const std::string text = fmt::format(
        "{{constant: 0.5, sun: {{towards: [{}, {}, {}], irradiance: [2, 1, 0.5], radius_deg: "
        "{}}}}}",
        one.towards.x, one.towards.y, one.towards.z, one.radius_deg);
    const base::Node node = base::parse_document(text, "e.yaml");
    const auto environment = read_environment({&node, {}});
    const glm::vec3 towards = glm::normalize(one.towards);
    // Midpoints in polar angle and azimuth about the y axis, as fine as a pixel's eighth.
    glm::dvec3 light(0.0);
    constexpr int kRows = 1024;
    for (int row = 0; row < kRows; ++row) {
      const double polar = std::numbers::pi * (row + 0.5) / kRows;
      for (int column = 0; column < 2 * kRows; ++column) {
        const double azimuth = std::numbers::pi * (column + 0.5) / kRows;
        const glm::vec3 direction(std::sin(polar) * std::cos(azimuth), std::cos(polar),
                                  std::sin(polar) * std::sin(azimuth));
        const float cosine = glm::dot(direction, towards);
        if (cosine <= 0.0F) continue;
        const double solid_angle_sr =
            std::sin(polar) * std::numbers::pi * std::numbers::pi / kRows / kRows;
        light += solid_angle_sr * static_cast<double>(cosine) *
                 glm::dvec3(sample_environment(*environment, direction) - glm::vec3(0.5F));
      }
    }
    EXPECT_NEAR(light.x, 2.0, 0.01) << text;
    EXPECT_NEAR(light.y, 1.0, 0.005) << text;
    EXPECT_NEAR(light.z, 0.5, 0.0025) << text;
    EXPECT_GT(sample_environment(*environment, towards).x, 1.5F);
    EXPECT_EQ(sample_environment(*environment, -towards), glm::vec3(0.5F));
  }
  const auto error_of = [](const char* sun) {
    const base::Node node =
        base::parse_document(std::string("{constant: 0.5, sun: ") + sun + "}", "e.yaml");
    return tests::input_error_of([&] { read_environment({&node, {}}); });
  };
  EXPECT_EQ(error_of("{towards: [0, 1, 0], irradiance: 1, radius_deg: 0.1}"),
            "e.yaml:1:70: radius_deg 0.1 of the sun; accepted: 0.5 to 45");
  EXPECT_NE(error_of("{towards: [0, 1, 0]}").find("irradiance"), std::string::npos);
}

TEST(EnvironmentReader, ReadsAFile) {
  const tests::TemporaryFolder folder;
  auto image = perception::make_rgb_image(4, 2, perception::Encoding::scene_linear);
  for (float& value : image.pixels) value = 3.0F;
  perception::write_exr(folder.path() / "sky.exr", {{{"radiance", image}}, {}});
  const base::Node node = base::parse_document("{file: sky.exr}", "e.yaml");
  const auto environment = read_environment({&node, folder.path()});
  EXPECT_EQ(environment->image.width_px, 4);
  EXPECT_FLOAT_EQ(sample_environment(*environment, {0.0F, 1.0F, 0.0F}).y, 3.0F);
}

std::string camera_error(const std::string& camera) {
  const std::string text =
      tests::with(tests::kSmallScene,
                  "{position: [0, 0, -3], look_at: [0, 0, 0], vertical_fov_deg: 40}", camera);
  return tests::input_error_of([&] { tests::parse(text); });
}

TEST(CameraReader, MissingCameraSaysWhatToAdd) {
  const std::string text =
      tests::with(tests::kSmallScene,
                  "camera: {position: [0, 0, -3], look_at: [0, 0, 0], vertical_fov_deg: 40}\n", "");
  EXPECT_EQ(tests::input_error_of([&] { tests::parse(text); }),
            "small.yaml:1:1: scene has no camera; add camera: {position, look_at, "
            "vertical_fov_deg}");
}

TEST(CameraReader, BadViewsAreRefused) {
  EXPECT_EQ(camera_error("{position: [0, 0, -3], look_at: [0, 0, -3], vertical_fov_deg: 40}"),
            "small.yaml:3:41: look_at is the camera's position");
  EXPECT_EQ(camera_error("{position: [0, 0, -3], look_at: [0, 9, -3], vertical_fov_deg: 40}"),
            "small.yaml:3:41: the camera looks along its up direction; change up");
  EXPECT_EQ(camera_error("{position: [0, 0, -3], look_at: [0, 0, 0], vertical_fov_deg: 180}"),
            "small.yaml:3:70: vertical_fov_deg 180 is outside (0, 180)");
  EXPECT_NE(camera_error("{position: [0, 0, -3], look_at: [0, 0, 0]}"), "no error");
}

}  // namespace
}  // namespace renderers::scene
