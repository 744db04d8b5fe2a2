#include "renderers/scene/scene.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <memory>
#include <numbers>

namespace renderers::scene {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

void expect_near(const glm::vec3& a, const glm::vec3& b, float tolerance = 1e-6F) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}

Light spot() {
  Light light;
  light.type = LightType::spot;
  light.intensity = {2.0F, 4.0F, 8.0F};
  light.inner_cone_rad = kPi / 6.0F;
  light.outer_cone_rad = kPi / 3.0F;
  return light;
}

glm::vec3 down_by(float angle_rad) { return {std::sin(angle_rad), -std::cos(angle_rad), 0.0F}; }

Object corner_triangle(const glm::vec3& shift) {
  auto mesh = std::make_shared<Mesh>();
  // The last vertex belongs to no triangle.
  mesh->positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, -1}, {99, 99, 99}};
  mesh->triangles = {{0, 1, 2}};
  Object object;
  object.mesh = mesh;
  object.to_world[3] = glm::vec4(shift, 1.0F);
  return object;
}

TEST(BoundingBox, HoldsAllTrianglesInWorldSpace) {
  Scene scene;
  EXPECT_EQ(bounding_box(scene).diagonal_m(), 0.0F);
  scene.objects = {corner_triangle({0, 0, 0}), corner_triangle({10, 0, 5})};
  const Box box = bounding_box(scene);
  EXPECT_EQ(box.least, glm::vec3(0, 0, -1));
  EXPECT_EQ(box.greatest, glm::vec3(11, 2, 5));
  EXPECT_FLOAT_EQ(box.diagonal_m(), std::sqrt(121.0F + 4.0F + 36.0F));
}

TEST(Intensity, PointIsTheSameEverywhere) {
  Light light;
  light.intensity = {1.0F, 2.0F, 3.0F};
  expect_near(intensity_towards(light, {0.0F, 1.0F, 0.0F}), {1.0F, 2.0F, 3.0F});
  expect_near(intensity_towards(light, {0.6F, 0.0F, 0.8F}), {1.0F, 2.0F, 3.0F});
}

TEST(Intensity, SpotIsFullInsideAndZeroOutside) {
  expect_near(intensity_towards(spot(), down_by(0.0F)), spot().intensity);
  expect_near(intensity_towards(spot(), down_by(0.52F)), spot().intensity);
  expect_near(intensity_towards(spot(), down_by(1.06F)), glm::vec3(0.0F));
  expect_near(intensity_towards(spot(), {0.0F, 1.0F, 0.0F}), glm::vec3(0.0F));
}

TEST(Intensity, SpotFallsOffSmoothlyInTheCosine) {
  // A quarter of the way in cosine: t = 0.25, t^2 (3 - 2 t) = 0.15625.
  const float cosine = 0.5F + 0.25F * (std::cos(kPi / 6.0F) - 0.5F);
  expect_near(intensity_towards(spot(), down_by(std::acos(cosine))), 0.15625F * spot().intensity,
              1e-5F);
}

TEST(Intensity, EqualConesMakeAStep) {
  Light light = spot();
  light.outer_cone_rad = light.inner_cone_rad;
  expect_near(intensity_towards(light, down_by(kPi / 6.0F - 0.001F)), light.intensity);
  expect_near(intensity_towards(light, down_by(kPi / 6.0F + 0.001F)), glm::vec3(0.0F));
}

/// 2 x 2: red, green above blue, white.
Texture four_colors() {
  Texture texture;
  texture.image = perception::make_rgb_image(2, 2, perception::Encoding::scene_linear);
  texture.image.at(0, 0, 0) = 1.0F;
  texture.image.at(1, 0, 1) = 1.0F;
  texture.image.at(0, 1, 2) = 1.0F;
  for (int i = 0; i < 3; ++i) texture.image.at(1, 1, i) = 1.0F;
  return texture;
}

TEST(Texture, FirstRowIsTheTop) {
  expect_near(sample_texture(four_colors(), {0.25F, 0.75F}), {1.0F, 0.0F, 0.0F});
  expect_near(sample_texture(four_colors(), {0.75F, 0.75F}), {0.0F, 1.0F, 0.0F});
  expect_near(sample_texture(four_colors(), {0.25F, 0.25F}), {0.0F, 0.0F, 1.0F});
}

TEST(Texture, BlendsLinearlyAndRepeats) {
  expect_near(sample_texture(four_colors(), {0.5F, 0.75F}), {0.5F, 0.5F, 0.0F});
  expect_near(sample_texture(four_colors(), {0.0F, 0.75F}), {0.5F, 0.5F, 0.0F});
  expect_near(sample_texture(four_colors(), {0.5F, 0.5F}), {0.5F, 0.5F, 0.5F});
  expect_near(sample_texture(four_colors(), {-2.75F, 3.75F}), {1.0F, 0.0F, 0.0F});
}

/// 4 x 2, every pixel of the upper row has its column as value, the lower row 10 more.
Environment numbered() {
  Environment environment;
  environment.image = perception::make_rgb_image(4, 2, perception::Encoding::scene_linear);
  for (int x = 0; x < 4; ++x) {
    for (int i = 0; i < 3; ++i) {
      environment.image.at(x, 0, i) = static_cast<float>(x);
      environment.image.at(x, 1, i) = static_cast<float>(10 + x);
    }
  }
  return environment;
}

TEST(Environment, CentreLooksAlongZAndColumnsGrowTowardsMinusX) {
  const Environment environment = numbered();
  expect_near(sample_environment(environment, {0.0F, 0.0F, 1.0F}), glm::vec3(6.5F));
  // Column 2 has its centre an eighth of a turn from +z towards -x.
  const float h = std::sqrt(0.5F);
  expect_near(sample_environment(environment, {-h, 0.0F, h}), glm::vec3(7.0F), 1e-5F);
  expect_near(sample_environment(environment, {h, 0.0F, h}), glm::vec3(6.0F), 1e-5F);
}

TEST(Environment, SeamAtMinusZBlendsLastAndFirstColumn) {
  expect_near(sample_environment(numbered(), {0.0F, 0.0F, -1.0F}), glm::vec3(6.5F), 1e-4F);
  // A quarter turn from +z to either side lies between columns 0, 1 and 2, 3.
  expect_near(sample_environment(numbered(), {1.0F, 0.0F, 0.0F}), glm::vec3(5.5F), 1e-5F);
  expect_near(sample_environment(numbered(), {-1.0F, 0.0F, 0.0F}), glm::vec3(7.5F), 1e-5F);
}

TEST(Environment, TopIsRowZero) {
  const float value = sample_environment(numbered(), {0.0F, 1.0F, 0.0F}).x;
  EXPECT_LT(value, 4.0F);
  EXPECT_GE(sample_environment(numbered(), {0.0F, -1.0F, 0.0F}).x, 10.0F);
}

TEST(Environment, RotationTurnsZTowardsX) {
  Environment environment = numbered();
  environment.rotation_rad = kPi / 2.0F;
  environment.scale = 2.0F;
  expect_near(sample_environment(environment, {1.0F, 0.0F, 0.0F}), glm::vec3(13.0F), 1e-4F);
}

TEST(Environment, DirectionInvertsPosition) {
  Environment environment = numbered();
  environment.rotation_rad = 0.7F;
  for (const float x : {0.1F, 0.4F, 0.6F, 0.9F}) {
    for (const float y : {0.2F, 0.5F, 0.8F}) {
      const glm::vec2 back =
          environment_position(environment, environment_direction(environment, {x, y}));
      EXPECT_NEAR(back.x, x, 1e-5F);
      EXPECT_NEAR(back.y, y, 1e-5F);
    }
  }
}

Camera square_camera() {
  Camera camera;
  camera.vertical_fov_deg = 90.0F;
  return camera;
}

TEST(CameraRay, CentreLooksForward) {
  expect_near(camera_ray_direction(square_camera(), 200, 100, 100.0F, 50.0F), {0.0F, 0.0F, 1.0F});
}

TEST(CameraRay, LookingAlongZLeftOfThePictureIsPlusX) {
  // Right-handed, y up, looking along +z: +x is on the left.
  expect_near(camera_ray_direction(square_camera(), 200, 100, 0.0F, 50.0F),
              glm::normalize(glm::vec3(2.0F, 0.0F, 1.0F)));
}

TEST(CameraRay, FieldOfViewIsVertical) {
  expect_near(camera_ray_direction(square_camera(), 200, 100, 100.0F, 0.0F),
              glm::normalize(glm::vec3(0.0F, 1.0F, 1.0F)));
  expect_near(camera_ray_direction(square_camera(), 200, 100, 100.0F, 100.0F),
              glm::normalize(glm::vec3(0.0F, -1.0F, 1.0F)));
}

TEST(Features, AreThoseInUse) {
  Scene scene;
  scene.materials.resize(2);
  scene.materials[1].emission = glm::vec3(1.0F);
  scene.objects.push_back({"plate", std::make_shared<Mesh>(), 0, glm::mat4(1.0F)});
  EXPECT_TRUE(features_of(scene).empty()) << "the emissive material is not in use";
  scene.objects[0].material = 1;
  scene.materials[1].lobe.albedo = glm::vec3(0.1F);
  scene.materials[1].albedo_texture = 0;
  scene.lights.resize(2);
  scene.lights[1].type = LightType::spot;
  scene.environment = std::make_shared<Environment>();
  scene.is_animated = true;
  std::string names;
  for (const Feature feature : features_of(scene)) names += to_string(feature) + " ";
  EXPECT_EQ(names, "point-light spot-light area-light environment texture glossy animation ");
}

}  // namespace
}  // namespace renderers::scene
