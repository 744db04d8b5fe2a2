#include "renderers/scene/mesh_file.h"

#include "tests/renderers/scene/mesh_file_fixture.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <cstdint>
#include <cstring>

namespace renderers::scene {
namespace {

constexpr const char* kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

double volume(const Mesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles) {
    sum += glm::dot(mesh.positions[t.x], glm::cross(mesh.positions[t.y], mesh.positions[t.z])) / 6;
  }
  return sum;
}

TEST_F(MeshFile, ReadsObj) {
  const Mesh mesh = read(file("a.obj", kTetrahedron));
  EXPECT_EQ(mesh.triangles.size(), 4U);
  EXPECT_NEAR(volume(mesh), 1.0 / 6.0, 1e-6);
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(MeshFile, SmoothNormalsPointAwayFromTheMiddle) {
  MeshFileOptions options;
  options.normals = MeshNormals::smooth;
  const Mesh mesh = read(file("a.obj", kTetrahedron), options);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    EXPECT_NEAR(glm::length(mesh.normals[i]), 1.0F, 1e-5F);
    EXPECT_GT(glm::dot(mesh.normals[i], mesh.positions[i] - glm::vec3(0.25F)), 0.0F);
  }
}

TEST_F(MeshFile, SmoothNormalsWeighByAngle) {
  // Three faces meet at the right-angled corner with 90 degrees each: the mean is their diagonal.
  MeshFileOptions options;
  options.normals = MeshNormals::smooth;
  const Mesh mesh = read(file("a.obj", kTetrahedron), options);
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    if (glm::length(mesh.positions[i]) > 0.0F) continue;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mesh.normals[i][c], -std::sqrt(1.0F / 3.0F), 1e-5F);
  }
}

TEST_F(MeshFile, FitHeightStandsOnTheGround) {
  MeshFileOptions options;
  options.fit_height_m = 3.0F;
  const Mesh mesh =
      read(file("a.obj", "v 1 1 1\nv 3 1 1\nv 1 2 1\nv 1 1 5\nf 1 3 2\nf 1 2 4\n"), options);
  glm::vec3 low(1e9F);
  glm::vec3 high(-1e9F);
  for (const auto& p : mesh.positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  EXPECT_EQ(low, glm::vec3(-3, 0, -6));
  EXPECT_EQ(high, glm::vec3(3, 3, 6));
}

TEST_F(MeshFile, UpAxisKeepsTheFront) {
  MeshFileOptions options;
  for (const char* up : {"y", "z", "-z"}) {
    options.up = up;
    EXPECT_NEAR(volume(read(file("a.obj", kTetrahedron), options)), 1.0 / 6.0, 1e-6) << up;
  }
  options.up = "z";
  float highest = -1.0F;
  for (const auto& p :
       read(file("a.obj", "v 0 0 7\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), options).positions) {
    highest = std::max(highest, p.y);
  }
  EXPECT_EQ(highest, 7.0F);
}

TEST_F(MeshFile, ZeroAreaTrianglesAreDroppedAndCounted) {
  const Mesh mesh =
      read(file("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\nf 1 1 2\n"));
  EXPECT_EQ(mesh.triangles.size(), 1U);
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_EQ(warnings_[0], "a.obj: dropped 2 zero-area triangles of 3");
}

TEST_F(MeshFile, OnlyZeroAreaIsAnError) {
  EXPECT_EQ(error_of("a.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"),
            "a.obj: all 1 triangles have zero area");
}

TEST_F(MeshFile, BadObjIsRefusedWithItsLine) {
  EXPECT_EQ(error_of("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"),
            "a.obj:4: a face names vertex 9; the file has 3");
  EXPECT_EQ(error_of("a.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"),
            "a.obj:2: \"nan\" is not a finite number");
  EXPECT_EQ(error_of("a.obj", "v 0 0 0\nv 1 0 1e400\nv 0 1 0\nf 1 2 3\n"),
            "a.obj:2: \"1e400\" is not a finite number");
  EXPECT_EQ(error_of("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1\nf 1 2 3\n"),
            "a.obj:3: \"v\" has 2 numbers; at least 3");
  EXPECT_EQ(error_of("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2"),
            "a.obj:4: a face has 2 corners; at least 3");
  EXPECT_EQ(error_of("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 three\n"),
            "a.obj:4: \"three\" is not a face corner (v, v/vt, v//vn or v/vt/vn)");
  EXPECT_EQ(error_of("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), "a.obj: has no faces");
  EXPECT_EQ(error_of("a.obj", ""), "a.obj: the file is empty");
}

TEST_F(MeshFile, ObjCutBetweenLinesIsSuspected) {
  read(file("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\n"));
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_EQ(warnings_[0], "a.obj: 1 vertices belong to no face; is the file complete?");
}

TEST_F(MeshFile, ObjNegativeIndicesCountBack) {
  EXPECT_EQ(read(file("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n")).triangles.size(), 1U);
  EXPECT_EQ(error_of("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -4 -2 -1\n"),
            "b.obj:4: a face names vertex -4; the file has 3");
}

constexpr const char* kPlyHeader =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
    "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";

TEST_F(MeshFile, ReadsPly) {
  const Mesh mesh = read(file("a.ply", std::string(kPlyHeader) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
  EXPECT_EQ(mesh.triangles.size(), 1U);
}

TEST_F(MeshFile, BadPlyIsRefused) {
  const std::string header = kPlyHeader;
  EXPECT_EQ(error_of("a.ply", header + "0 0 0\n1 0 0\n0 1 0\n3 0 1"),
            "a.ply: truncated: the data end at face 0 of 1");
  EXPECT_EQ(error_of("a.ply", header + "0 0 0\n1 0 0\n0 1"),
            "a.ply: truncated: the data end at vertex 2 of 3");
  EXPECT_EQ(error_of("a.ply", header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"),
            "a.ply: face 0 names vertex 7; the file has 3");
  EXPECT_EQ(error_of("a.ply", header + "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"),
            "a.ply: vertex 1 has a value that is not finite");
  EXPECT_EQ(error_of("a.ply", "ply\nformat ascii 1.0\nelement ver"),
            "a.ply: truncated: the PLY header has no end_header");
  // Headers that two readers would understand differently.
  const std::string start = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n";
  EXPECT_EQ(error_of("a.ply", start + "element vertex 3\nend_header\n"),
            "a.ply: element vertex is listed twice; accepted: once");
  EXPECT_EQ(
      error_of("a.ply", start + "property floet y\nend_header\n"),
      "a.ply: unknown PLY type \"floet\"; known: char, uchar, short, ushort, int, uint, float, "
      "double, and int8 to float64");
  EXPECT_EQ(error_of("a.ply", start + "pro`erty float y\nend_header\n"),
            "a.ply: cannot read the header line \"pro`erty float y\"; accepted: format, element, "
            "property, comment, obj_info");
  EXPECT_EQ(error_of("a.ply", "hello"), "a.ply: not a PLY file: it must begin with ply");
}

/// The triangle as binary PLY.
std::string binary_ply() {
  std::string bytes = tests::with(kPlyHeader, "ascii", "binary_little_endian");
  const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::int32_t indices[3] = {0, 1, 2};
  bytes.append(reinterpret_cast<const char*>(positions), sizeof(positions));
  bytes += '\3';
  bytes.append(reinterpret_cast<const char*>(indices), sizeof(indices));
  return bytes;
}

TEST_F(MeshFile, BinaryPlyCutAnywhereIsRefused) {
  const std::string whole = binary_ply();
  EXPECT_EQ(read(file("a.ply", whole)).triangles.size(), 1U);
  for (std::size_t cut = 1; cut < 40; ++cut) {
    EXPECT_NE(error_of("a.ply", whole.substr(0, whole.size() - cut)).find("truncated"),
              std::string::npos)
        << cut;
  }
}

TEST_F(MeshFile, UnknownFormatListsTheKnownOnes) {
  EXPECT_EQ(error_of("a.stl", "solid"),
            "a.stl: unknown mesh format \".stl\"; known: .obj, .ply, .3ds, .gltf, .glb");
}

TEST_F(MeshFile, GarbageThatLooksRightIsRefused) {
  EXPECT_NE(error_of("a.gltf", "{\"asset\": {"), "no error");
}

}  // namespace
}  // namespace renderers::scene
