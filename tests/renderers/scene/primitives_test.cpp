#include "renderers/scene/primitives.h"

#include "tests/expect_input_error.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <numbers>

namespace renderers::scene {
namespace {

base::Node node_of(const char* text) { return base::parse_document(text, "shape.yaml"); }

glm::vec3 face_normal(const Mesh& mesh, const glm::uvec3& t) {
  return glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                    mesh.positions[t.z] - mesh.positions[t.x]);
}

double area(const Mesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles) sum += 0.5 * glm::length(face_normal(mesh, t));
  return sum;
}

/// Signed volume by the divergence theorem: positive if the faces of a closed mesh point outwards.
double volume(const Mesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles) {
    sum += glm::dot(mesh.positions[t.x], face_normal(mesh, t)) / 6.0;
  }
  return sum;
}

TEST(Quad, FrontIsCrossOfItsEdges) {
  const Mesh mesh = read_quad(node_of("{origin: [1, 0, 0], edge_u: [0, 0, 2], edge_v: [3, 0, 0]}"));
  ASSERT_EQ(mesh.triangles.size(), 2U);
  for (const auto& t : mesh.triangles) EXPECT_GT(face_normal(mesh, t).y, 0.0F);
  EXPECT_DOUBLE_EQ(area(mesh), 6.0);
  EXPECT_EQ(mesh.uvs[1], glm::vec2(1.0F, 0.0F)) << "u runs along edge_u";
}

TEST(Quad, ParallelEdgesAreRefused) {
  EXPECT_EQ(tests::input_error_of([] {
              read_quad(node_of("{origin: [0, 0, 0], edge_u: [1, 1, 0], edge_v: [2, 2, 0]}"));
            }),
            "shape.yaml:1:1: edge_u and edge_v of a quad must not be parallel");
}

TEST(Quad, SegmentsCutItFinerAndGiveNormals) {
  const char* text = "{origin: [1, 0, 0], edge_u: [0, 0, 2], edge_v: [3, 0, 0], segments: [4, 3]}";
  const Mesh mesh = read_quad(node_of(text));
  ASSERT_EQ(mesh.triangles.size(), 24U);
  EXPECT_EQ(mesh.positions.size(), 20U);
  for (const auto& t : mesh.triangles) EXPECT_GT(face_normal(mesh, t).y, 0.0F);
  EXPECT_NEAR(area(mesh), 6.0, 1e-5);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    EXPECT_EQ(mesh.normals[i], glm::vec3(0, 1, 0));
    const glm::vec3 expected(1.0F + 3.0F * mesh.uvs[i].y, 0.0F, 2.0F * mesh.uvs[i].x);
    EXPECT_LT(glm::distance(mesh.positions[i], expected), 1e-6F);
  }
  EXPECT_EQ(
      tests::input_error_of([] {
        read_quad(node_of(
            "{origin: [0, 0, 0], edge_u: [1, 0, 0], edge_v: [0, 1, 0], segments: [1, 2, 3]}"));
      }),
      "shape.yaml:1:69: segments has 3 numbers; give one, or [u, v]");
}

TEST(Box, SidesCanBeOmittedAndCut) {
  const Mesh box = read_box(node_of("{min: [0, 0, 0], max: [1, 2, 3], segments: 2}"));
  EXPECT_EQ(box.triangles.size(), 48U);
  EXPECT_NEAR(volume(box), 6.0, 1e-5);
  const Mesh open = read_box(node_of("{min: [0, 0, 0], max: [1, 2, 3], omit: [-y, +x]}"));
  EXPECT_EQ(open.triangles.size(), 8U);
  for (const auto& t : open.triangles) {
    EXPECT_GE(face_normal(open, t).y, 0.0F);
    EXPECT_LE(face_normal(open, t).x, 0.0F);
  }
  EXPECT_EQ(
      tests::input_error_of(
          [] { read_box(node_of("{min: [0, 0, 0], max: [1, 1, 1], omit: [y]}")); }),
      "shape.yaml:1:41: unknown side of a box \"y\"; did you mean \"+y\"? known: +x, -x, +y, -y, "
      "+z, -z");
  EXPECT_EQ(tests::input_error_of([] {
              read_box(node_of("{min: [0, 0, 0], max: [1, 1, 1], omit: [+x, -x, +y, -y, +z, -z]}"));
            }),
            "shape.yaml:1:40: omit leaves no side of the box");
}

TEST(Polygons, AreCutIntoFans) {
  const Mesh mesh = read_polygons(
      node_of("[[[0, 0, 0], [2, 0, 0], [2, 2, 0], [1, 3, 0], [0, 2, 0]], [[0, 0, 1], [1, 0, 1], "
              "[0, 1, 1]]]"));
  EXPECT_EQ(mesh.triangles.size(), 4U);
  EXPECT_DOUBLE_EQ(area(mesh), 5.5);
}

TEST(Polygons, TwoCornersAreRefused) {
  EXPECT_EQ(tests::input_error_of([] { read_polygons(node_of("[[[0, 0, 0], [2, 0, 0]]]")); }),
            "shape.yaml:1:2: a polygon has 2 corners; at least 3");
}

TEST(Box, FacesOutOrIn) {
  const Mesh out = read_box(node_of("{min: [0, 0, 0], max: [1, 2, 3]}"));
  EXPECT_EQ(out.triangles.size(), 12U);
  EXPECT_NEAR(volume(out), 6.0, 1e-5);
  EXPECT_NEAR(area(out), 22.0, 1e-5);
  EXPECT_NEAR(volume(read_box(node_of("{min: [0, 0, 0], max: [1, 2, 3], facing: in}"))), -6.0,
              1e-5);
}

TEST(Box, MinMustBeBelowMax) {
  EXPECT_EQ(tests::input_error_of([] { read_box(node_of("{min: [0, 0, 0], max: [1, 0, 1]}")); }),
            "shape.yaml:1:1: min of a box must be less than max in x, y and z");
  EXPECT_EQ(tests::input_error_of(
                [] { read_box(node_of("{min: [0, 0, 0], max: [1, 1, 1], facing: up}")); }),
            "shape.yaml:1:42: facing \"up\" is unknown; known: out, in");
}

TEST(Sphere, VolumeAndNormals) {
  const Mesh mesh = read_sphere(node_of("{center: [1, 2, 3], radius: 2, segments: 128}"));
  EXPECT_NEAR(volume(mesh), 32.0 / 3.0 * std::numbers::pi, 0.06);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3 radial = (mesh.positions[i] - glm::vec3(1, 2, 3)) / 2.0F;
    EXPECT_NEAR(glm::dot(radial, mesh.normals[i]), 1.0F, 1e-5F);
  }
  const Mesh inside =
      read_sphere(node_of("{center: [1, 2, 3], radius: 2, segments: 128, facing: in}"));
  EXPECT_NEAR(volume(inside), -volume(mesh), 1e-6);
  EXPECT_NEAR(inside.normals[0].y, -mesh.normals[0].y, 1e-6F);
}

TEST(Sphere, FaceCount) {
  // 8 around, 4 rings: 2 rings of triangles at the poles, 2 of quads.
  const Mesh mesh = read_sphere(node_of("{center: [0, 0, 0], radius: 1, segments: 8}"));
  EXPECT_EQ(mesh.triangles.size(), 8U * 2U + 8U * 2U * 2U);
}

TEST(Disk, AreaAndFront) {
  const Mesh mesh =
      read_disk(node_of("{center: [0, 3, 0], normal: [0, -2, 0], radius: 2, segments: 256}"));
  EXPECT_EQ(mesh.triangles.size(), 256U);
  EXPECT_NEAR(area(mesh), 4.0 * std::numbers::pi, 2e-3);
  for (const auto& t : mesh.triangles) EXPECT_LT(face_normal(mesh, t).y, 0.0F);
}

TEST(Disk, BadSettingsAreRefused) {
  EXPECT_EQ(tests::input_error_of(
                [] { read_disk(node_of("{center: [0, 3, 0], normal: [0, 0, 0], radius: 2}")); }),
            "shape.yaml:1:29: normal has length 0");
  EXPECT_EQ(tests::input_error_of([] {
              read_disk(node_of("{center: [0, 3, 0], normal: [0, 1, 0], radius: 2, segments: 2}"));
            }),
            "shape.yaml:1:61: segments 2 is outside [3, 4096]");
}

}  // namespace
}  // namespace renderers::scene
