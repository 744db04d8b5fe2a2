#include "renderers/scene/deformation.h"

#include "tests/expect_input_error.h"
#include "tests/renderers/scene/scene_text.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <numbers>

namespace renderers::scene {
namespace {

constexpr double kPi = std::numbers::pi;

std::vector<Deformation> read(const std::string& text) {
  return read_deformations(base::parse_document(text, "deform.yaml"));
}

const char* const kTwist = "[{type: twist, axis: y, center: [1, 0, 0], rate_deg_per_m: 90}]";
const char* const kBend =
    "[{type: bend, axis: y, towards: z, from: 0, to: 1, curvature_deg_per_m: 90}]";
const char* const kWave =
    "[{type: wave, along: x, towards: y, amplitude: 0.5, wavelength: 2, phase_deg: 30, ramp: "
    "{axis: z, from: 2, to: -1}}]";

DeformedPoint moved(const char* text, const glm::dvec3& point) {
  const Deformation deformation = read(text)[0];
  return deform_point(deformation, deformation.numbers.keys[0].value, point);
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-9) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}

TEST(Twist, TurnsByTheHeight) {
  expect_near(moved(kTwist, {2, 0, 0}).position, {2, 0, 0});
  expect_near(moved(kTwist, {2, 1, 0}).position, {1, 1, -1});
  expect_near(moved(kTwist, {2, 2, 0}).position, {0, 2, 0});
  expect_near(moved(kTwist, {1, 7, 0}).position, {1, 7, 0});
}

TEST(Bend, MakesAQuarterCircle) {
  const double radius = 2.0 / kPi;
  expect_near(moved(kBend, {3, 0, 0}).position, {3, 0, 0});
  expect_near(moved(kBend, {3, 1, 0}).position, {3, radius, radius});
  expect_near(moved(kBend, {3, 1, 0.1}).position, {3, radius - 0.1, radius});
  expect_near(moved(kBend, {3, 1.5, 0}).position, {3, radius, radius + 0.5}, 1e-9);
  expect_near(moved(kBend, {3, -2, 0.1}).position, {3, -2, 0.1});
}

TEST(Bend, WithoutCurvatureChangesNothing) {
  const char* flat = "[{type: bend, axis: x, towards: y, from: -1, to: 1, curvature_deg_per_m: 0}]";
  expect_near(moved(flat, {0.3, 0.4, 0.5}).position, {0.3, 0.4, 0.5});
}

TEST(Wave, IsASineThatGrowsAlongItsRamp) {
  const double full = 0.5 * std::sin(kPi * 0.25 + kPi / 6.0);
  expect_near(moved(kWave, {0.25, 7, -1}).position, {0.25, 7 + full, -1});
  expect_near(moved(kWave, {0.25, 7, -4}).position, {0.25, 7 + full, -4});
  expect_near(moved(kWave, {0.25, 7, 0.5}).position, {0.25, 7 + 0.5 * full, 0.5});
  expect_near(moved(kWave, {0.25, 7, 3}).position, {0.25, 7, 3});
}

TEST(Deformations, JacobianIsTheDerivative) {
  constexpr double kStep = 1e-5;
  for (const char* text : {kTwist, kBend, kWave}) {
    for (const glm::dvec3& p :
         {glm::dvec3(0.3, 0.4, 0.1), {1.4, 0.9, -0.5}, {-2, 1.7, 0.3}, {0.2, -0.6, 0.2}}) {
      const glm::dmat3 jacobian = moved(text, p).jacobian;
      for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 step(0.0);
        step[axis] = kStep;
        const glm::dvec3 slope =
            (moved(text, p + step).position - moved(text, p - step).position) / (2.0 * kStep);
        expect_near(jacobian[axis], slope, 1e-8);
      }
    }
  }
}

TEST(Deformations, DeterminantsAreKnown) {
  const glm::dvec3 p(0.3, 0.4, 0.1);
  EXPECT_NEAR(glm::determinant(moved(kTwist, p).jacobian), 1.0, 1e-12);
  EXPECT_NEAR(glm::determinant(moved(kWave, p).jacobian), 1.0, 1e-12);
  EXPECT_NEAR(glm::determinant(moved(kBend, p).jacobian), 1.0 - 0.5 * kPi * 0.1, 1e-12);
}

/// A finely cut plate in x and y at z = 0, its front along +z.
const std::string kPlate = tests::with(tests::kSmallScene, "edge_v: [0, 1, 0]}",
                                       "edge_v: [0, 1, 0], segments: 64}, deform: DEFORM");

Mesh plate_with(const std::string& deform) {
  return *tests::parse(tests::with(kPlate, "DEFORM", deform)).at_frame(0).objects[0].mesh;
}

TEST(Deform, NormalsAreThoseOfTheNewSurface) {
  // y bends towards z: at height y the plate's front leans by the angle y / radius.
  const Mesh bent = plate_with(kBend);
  for (std::size_t i = 0; i < bent.positions.size(); ++i) {
    const double angle =
        std::atan2(static_cast<double>(-bent.normals[i].y), static_cast<double>(bent.normals[i].z));
    EXPECT_NEAR(angle, 0.5 * kPi * static_cast<double>(bent.uvs[i].y), 1e-5);
  }
  // z = A sin(2 pi x): the normal is (-dz/dx, 0, 1); multiplied by the Jacobian itself it would
  // not turn at all.
  const Mesh waved =
      plate_with("[{type: wave, along: x, towards: z, amplitude: 0.1, wavelength: 1}]");
  for (std::size_t i = 0; i < waved.positions.size(); ++i) {
    const double slope = 0.2 * kPi * std::cos(2.0 * kPi * static_cast<double>(waved.uvs[i].x));
    expect_near(glm::dvec3(waved.normals[i]), glm::normalize(glm::dvec3(-slope, 0, 1)), 1e-5);
  }
}

TEST(Deform, EntriesActInOrder) {
  const std::string twist = "{type: twist, axis: z, rate_deg_per_m: 90}";
  const std::string wave = "{type: wave, along: x, towards: z, amplitude: 1, wavelength: 4}";
  const glm::vec3 first = plate_with("[" + wave + ", " + twist + "]").positions.back();
  const glm::vec3 second = plate_with("[" + twist + ", " + wave + "]").positions.back();
  EXPECT_GT(glm::distance(first, second), 0.1F);
}

TEST(Deform, ActsBeforeTheTransformAndMovesWithItsKeys) {
  const std::string moving =
      "[{type: twist, axis: y, rate_deg_per_m: 0, animation: {keys: [{frame: 0}, {frame: 10, "
      "rate_deg_per_m: 180}]}}], transform: {translate: [5, 0, 0]}";
  const SceneFile file = tests::parse(tests::with(kPlate, "DEFORM", moving));
  EXPECT_EQ(file.frame_count(), 11);
  EXPECT_TRUE(file.at_frame(0).is_animated);
  const auto corner = [&](int frame) {
    return file.at_frame(frame).objects[0].mesh->positions.back();
  };
  EXPECT_LT(glm::distance(corner(0), glm::vec3(0, 1, 0)), 2.0F);
  const glm::vec3 before = corner(0);
  const glm::vec3 half = corner(5);
  EXPECT_NEAR(half.z, -before.x, 1e-5F) << "a quarter turn at y = 1";
  EXPECT_EQ(corner(10), corner(60));
  EXPECT_NE(file.at_frame(5).hash, file.at_frame(6).hash);
  EXPECT_EQ(file.at_frame(5).hash, file.at_frame(5).hash);
}

TEST(Deform, AtRestIsDoneOnce) {
  const SceneFile file = tests::parse(tests::with(kPlate, "DEFORM", kBend));
  EXPECT_FALSE(file.at_frame(0).is_animated);
  EXPECT_EQ(file.at_frame(0).objects[0].mesh, file.at_frame(1).objects[0].mesh);
}

TEST(Deform, AppliesToRegeneratedMeshes) {
  const std::string text =
      tests::kSmallScene +
      "  - {name: wax, generator: {name: metaballs, balls: 2, size: [1, 1, 1], "
      "radius: [0.2, 0.3], frames: 3}, deform: DEFORM}\n";
  const auto top_of = [&](const char* deform) {
    const Scene scene = tests::parse(tests::with(text, "DEFORM", deform)).at_frame(1);
    float top = -1e9F;
    for (const glm::vec3& p : scene.objects[1].mesh->positions) top = std::max(top, p.y);
    return top;
  };
  const char* none = "[{type: wave, along: x, towards: y, amplitude: 0, wavelength: 1}]";
  const char* shift =
      "[{type: wave, along: x, towards: y, amplitude: 2, wavelength: 1e9, "
      "phase_deg: 90}]";
  EXPECT_NEAR(top_of(shift), top_of(none) + 2.0F, 1e-4F);
}

std::string error_of(const std::string& text) {
  return tests::input_error_of([&] { read(text); });
}

TEST(ReadDeformations, BadOnesAreRefused) {
  EXPECT_EQ(error_of("[]"), "deform.yaml:1:1: deform has no entries");
  EXPECT_EQ(error_of("[{type: twirl}]"),
            "deform.yaml:1:9: unknown type of deformation \"twirl\"; known: bend, twist, wave");
  EXPECT_EQ(error_of("[{type: twist, axis: w, rate_deg_per_m: 1}]"),
            "deform.yaml:1:22: axis \"w\" is unknown; known: x, y, z");
  EXPECT_EQ(error_of("[{type: twist, axis: x, rate_deg_per_m: 1, rate: 2}]"),
            "deform.yaml:1:44: unknown key \"rate\"; known: type, axis, center, rate_deg_per_m, "
            "animation in deformation");
  EXPECT_EQ(error_of("[{type: wave, along: x, towards: x, amplitude: 1, wavelength: 1}]"),
            "deform.yaml:1:34: towards and along must differ");
  EXPECT_EQ(error_of("[{type: wave, along: x, towards: y, amplitude: 1, wavelength: 0}]"),
            "deform.yaml:1:2: wavelength 0 must be greater than 0");
  EXPECT_EQ(error_of("[{type: bend, axis: x, towards: y, from: 1, to: 2, "
                     "curvature_deg_per_m: 1}]"),
            "deform.yaml:1:2: a bend from 1 to 2: must satisfy from <= 0 <= to, from < to; they "
            "count from the centre");
  EXPECT_EQ(error_of("[{type: wave, along: x, towards: y, amplitude: 1, wavelength: 1, ramp: "
                     "{axis: y, from: 0, to: 1}}]"),
            "deform.yaml:1:72: axis of ramp and towards must differ");
}

TEST(Deform, ABendThatTurnsTheMeshInsideOutIsRefused) {
  EXPECT_EQ(tests::input_error_of([] {
              plate_with(
                  "[{type: bend, axis: y, towards: x, from: 0, to: 1, "
                  "curvature_deg_per_m: 90}]");
            }),
            "small.yaml:6:107: bend of 90 degrees per metre turns parts of the mesh inside out: "
            "they reach beyond the circle's centre, 0.63662 m from the axis; lower "
            "curvature_deg_per_m");
}

}  // namespace
}  // namespace renderers::scene
