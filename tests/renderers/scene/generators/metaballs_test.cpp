#include "renderers/scene/generators/metaballs.h"

#include "tests/expect_input_error.h"
#include "tests/renderers/scene/generators/mesh_facts.h"
#include "tests/renderers/scene/scene_text.h"

#include <gtest/gtest.h>

#include <numbers>

namespace renderers::scene {
namespace {

MetaballSettings one_ball() {
  MetaballSettings settings;
  settings.balls = 1;
  settings.least_radius_m = 0.3F;
  settings.greatest_radius_m = 0.3F;
  settings.resolution = 48;
  settings.frames = 10;
  return settings;
}

TEST(Metaballs, OneBallIsASphere) {
  const Metaballs balls(one_ball());
  const Mesh mesh = balls.at_frame(3);
  const Metaballs::Ball ball = balls.balls_at(3)[0];
  const double r = static_cast<double>(ball.radius_m);
  EXPECT_EQ(tests::open_edges(mesh), 0);
  EXPECT_NEAR(tests::area_m2(mesh), 4.0 * std::numbers::pi * r * r, 0.03);
  EXPECT_NEAR(tests::volume_m3(mesh), 4.0 / 3.0 * std::numbers::pi * r * r * r, 0.003);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3 radial = mesh.positions[i] - ball.center;
    EXPECT_NEAR(glm::length(radial), ball.radius_m, 0.003F);
    EXPECT_GT(glm::dot(mesh.normals[i], glm::normalize(radial)), 0.9999F);
  }
}

TEST(Metaballs, EveryFrameIsClosedAndNew) {
  MetaballSettings settings;
  settings.balls = 12;
  settings.frames = 20;
  const Metaballs balls(settings);
  Mesh last = balls.at_frame(0);
  for (int frame = 1; frame < settings.frames; ++frame) {
    const Mesh mesh = balls.at_frame(frame);
    EXPECT_EQ(tests::open_edges(mesh), 0) << "frame " << frame;
    // The gradient turns within a cube where two balls part.
    EXPECT_LT(tests::turned_normals(mesh), static_cast<int>(mesh.triangles.size() / 500))
        << "frame " << frame;
    EXPECT_NE(mesh.positions, last.positions) << "frame " << frame;
    last = mesh;
  }
  EXPECT_EQ(balls.at_frame(999).positions, last.positions) << "the last frame holds";
}

TEST(Metaballs, BallsStayInTheirBox) {
  MetaballSettings settings;
  settings.balls = 40;
  settings.frames = 60;
  settings.size_m = {2.0F, 1.0F, 0.5F};
  const Metaballs balls(settings);
  for (int frame = 0; frame < settings.frames; frame += 7) {
    for (const Metaballs::Ball& ball : balls.balls_at(frame)) {
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(std::abs(ball.center[axis]) + ball.radius_m,
                  0.5F * settings.size_m[axis] + 1e-5F);
      }
    }
  }
}

std::string scene_with(const std::string& generator) {
  return tests::kSmallScene + "  - {name: wax, generator: {name: metaballs, " + generator + "}}\n";
}

TEST(Metaballs, SceneHasTheirFrames) {
  const SceneFile file =
      tests::parse(scene_with("balls: 3, size: [1, 1, 1], radius: [0.1, 0.2], frames: 12"));
  EXPECT_EQ(file.frame_count(), 12);
  EXPECT_TRUE(file.at_frame(0).is_animated);
  EXPECT_NE(file.at_frame(3).hash, file.at_frame(4).hash);
  EXPECT_EQ(file.at_frame(3).hash, file.at_frame(3).hash);
  EXPECT_EQ(file.at_frame(11).hash, file.at_frame(50).hash);
  EXPECT_FALSE(tests::parse(scene_with("balls: 3, size: [1, 1, 1], radius: [0.1, 0.2]"))
                   .at_frame(0)
                   .is_animated);
}

TEST(Metaballs, BadSettingsAreRefused) {
  const auto error_of = [](const std::string& generator) {
    return tests::input_error_of([&] { tests::parse(scene_with(generator)); });
  };
  EXPECT_EQ(error_of("balls: 3, size: [1, 1, 1], radius: [0.1, 0.6]"),
            "small.yaml:7:81: radius [0.1, 0.6]: must satisfy 0 < least <= greatest <= half the "
            "shortest side of size, 0.5");
  EXPECT_EQ(error_of("balls: 0, size: [1, 1, 1], radius: [0.1, 0.2]"),
            "small.yaml:7:53: balls 0 is outside [1, 1000]");
  EXPECT_EQ(error_of("balls: 1, sise: [1, 1, 1], radius: [0.1, 0.2]"),
            "small.yaml:7:28: generator has no \"size\"; it is required");
}

}  // namespace
}  // namespace renderers::scene
