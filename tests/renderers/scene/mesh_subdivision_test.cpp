#include "renderers/scene/mesh_subdivision.h"

#include "renderers/scene/mesh_repair.h"
#include "renderers/scene/primitives.h"
#include "tests/renderers/scene/generators/mesh_facts.h"
#include "tests/renderers/scene/mesh_file_fixture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace renderers::scene {
namespace {

/// A sphere whose texture has a seam: a meridian of vertices that are there twice.
Mesh sphere() {
  Mesh mesh = read_sphere(
      base::parse_document("{center: [1, 2, 3], radius: 2, segments: 12}", "sphere.yaml"));
  // Its first and last meridian differ by rounding; here they are exactly the same.
  for (glm::vec3& position : mesh.positions) {
    position = *std::ranges::find_if(
        mesh.positions, [&](const glm::vec3& p) { return glm::distance(p, position) < 1e-5F; });
  }
  return mesh;
}

/// A quad 100 times as long as wide.
Mesh strip() {
  return read_quad(base::parse_document(
      "{origin: [0, 0, 0], edge_u: [1, 0, 0], edge_v: [0, 0, 100]}", "strip.yaml"));
}

/// The mesh with one vertex per position.
Mesh welded(const Mesh& mesh) {
  const std::vector<std::size_t> numbers = position_numbers(mesh);
  Mesh result;
  result.positions.resize(*std::ranges::max_element(numbers) + 1);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    result.positions[numbers[i]] = mesh.positions[i];
  }
  for (const glm::uvec3& t : mesh.triangles) {
    result.triangles.emplace_back(numbers[t.x], numbers[t.y], numbers[t.z]);
  }
  return result;
}

Mesh subdivided(Mesh mesh, std::size_t triangles) {
  subdivide_to(mesh, triangles);
  return mesh;
}

double least_angle_deg(const Mesh& mesh) {
  double largest_cosine = -1.0;
  for (const glm::uvec3& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 at(mesh.positions[t[i]]);
      const glm::dvec3 next = glm::dvec3(mesh.positions[t[(i + 1) % 3]]) - at;
      const glm::dvec3 last = glm::dvec3(mesh.positions[t[(i + 2) % 3]]) - at;
      largest_cosine =
          std::max(largest_cosine, glm::dot(glm::normalize(next), glm::normalize(last)));
    }
  }
  return std::acos(largest_cosine) * 180.0 / std::numbers::pi;
}

double longest_edge_m(const Mesh& mesh) {
  double longest = 0.0;
  for (const glm::uvec3& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      longest = std::max(longest, glm::distance(glm::dvec3(mesh.positions[t[i]]),
                                                glm::dvec3(mesh.positions[t[(i + 1) % 3]])));
    }
  }
  return longest;
}

TEST(Subdivision, ReachesTheNumberAndAtMostOneMore) {
  for (const std::size_t wanted : {265U, 266U, 1000U, 1001U, 5000U}) {
    const Mesh mesh = subdivided(sphere(), wanted);
    EXPECT_GE(mesh.triangles.size(), wanted);
    EXPECT_LE(mesh.triangles.size(), wanted + 1);
  }
  const Mesh same = subdivided(sphere(), 10);
  EXPECT_EQ(same.triangles, sphere().triangles) << "it has more already";
}

TEST(Subdivision, SurfaceStaysAsItIs) {
  const Mesh before = sphere();
  const Mesh after = subdivided(before, 4000);
  EXPECT_NEAR(tests::area_m2(after), tests::area_m2(before), 1e-6 * tests::area_m2(before));
  EXPECT_NEAR(tests::volume_m3(after), tests::volume_m3(before), 1e-6 * tests::volume_m3(before));
}

TEST(Subdivision, LeavesNoVertexInsideAnEdge) {
  ASSERT_EQ(tests::open_edges(welded(sphere())), 0);
  ASSERT_GT(tests::open_edges(sphere()), 0) << "its vertices differ along the seam";
  for (const std::size_t wanted : {300U, 1111U, 6000U}) {
    EXPECT_EQ(tests::open_edges(welded(subdivided(sphere(), wanted))), 0) << wanted;
  }
  // What it would be if one triangle alone were halved.
  Mesh cracked = welded(sphere());
  const glm::uvec3 t = cracked.triangles[0];
  const auto middle = static_cast<unsigned>(cracked.positions.size());
  cracked.positions.push_back(0.5F * (cracked.positions[t.x] + cracked.positions[t.y]));
  cracked.triangles[0] = {t.x, middle, t.z};
  cracked.triangles.emplace_back(middle, t.y, t.z);
  EXPECT_GT(tests::open_edges(cracked), 0);
}

TEST(Subdivision, TheSeamOfATextureStays) {
  const Mesh mesh = subdivided(sphere(), 2000);
  for (const glm::uvec3& t : mesh.triangles) {
    const float us[3] = {mesh.uvs[t.x].x, mesh.uvs[t.y].x, mesh.uvs[t.z].x};
    EXPECT_LE(std::ranges::max(us) - std::ranges::min(us), 1.0F / 12.0F + 1e-5F);
  }
}

TEST(Subdivision, NormalsAreUnitAndUvsAreMeans) {
  const Mesh round = subdivided(sphere(), 2000);
  ASSERT_EQ(round.normals.size(), round.positions.size());
  for (const glm::vec3& normal : round.normals) EXPECT_NEAR(glm::length(normal), 1.0F, 1e-5F);
  EXPECT_EQ(tests::turned_normals(round), 0);
  const Mesh flat = subdivided(strip(), 500);
  for (std::size_t i = 0; i < flat.positions.size(); ++i) {
    EXPECT_NEAR(flat.uvs[i].x, flat.positions[i].x, 1e-6F);
    EXPECT_NEAR(flat.uvs[i].y, flat.positions[i].z / 100.0F, 1e-6F);
  }
}

TEST(Subdivision, AnglesNeverFallBelowHalfOfTheLeast) {
  for (const Mesh& mesh : {sphere(), strip()}) {
    const double least_deg = least_angle_deg(mesh);
    for (const std::size_t wanted : {300U, 1000U, 4000U}) {
      EXPECT_GE(least_angle_deg(subdivided(mesh, wanted)), 0.5 * least_deg - 1e-6) << wanted;
    }
  }
}

TEST(Subdivision, TheLongestEdgesGoFirst) {
  double longest_m = longest_edge_m(sphere());
  for (const std::size_t wanted : {400U, 800U, 1600U, 3200U}) {
    const double now_m = longest_edge_m(subdivided(sphere(), wanted));
    EXPECT_LT(now_m, longest_m) << wanted;
    longest_m = now_m;
  }
}

TEST(Subdivision, IsTheSameEveryTimeAndStepByStep) {
  const Mesh at_once = subdivided(sphere(), 3000);
  const Mesh again = subdivided(sphere(), 3000);
  EXPECT_EQ(at_once.positions, again.positions);
  EXPECT_EQ(at_once.triangles, again.triangles);
  const Mesh first = subdivided(sphere(), 1000);
  const Mesh more = subdivided(first, 3000);
  EXPECT_NEAR(longest_edge_m(more), longest_edge_m(at_once), 1e-6);
}

TEST_F(MeshFile, SubdivideToIsReadAndChecked) {
  file("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const auto scene = [&](const std::string& more) {
    const std::string text = tests::with(
        tests::kSmallScene, "quad: {origin: [0, 0, 0], edge_u: [1, 0, 0], edge_v: [0, 1, 0]}",
        "mesh: {file: a.obj" + more + "}");
    return tests::parse(text, folder_.path()).at_frame(0);
  };
  const auto error_of = [&](const std::string& more) {
    return tests::input_error_of([&] { scene(more); });
  };
  EXPECT_EQ(scene("").face_count(), 4U);
  EXPECT_EQ(scene(", subdivide_to: 4").hash, scene("").hash);
  EXPECT_EQ(scene(", subdivide_to: 100").face_count(), 100U);
  EXPECT_EQ(error_of(", subdivide_to: 0"),
            "small.yaml:6:53: subdivide_to 0 is outside [1, 10000000]");
  EXPECT_EQ(error_of(", subdivide_to: 10000001"),
            "small.yaml:6:53: subdivide_to 10000001 is outside [1, 10000000]");
  EXPECT_EQ(error_of(", subdivide_to: 3"),
            "small.yaml:6:25: " + (folder_.path() / "a.obj").string() +
                ": has 4 faces; subdivide_to 3 must be at least that");
  EXPECT_EQ(
      error_of(", subdivide: 100"),
      "small.yaml:6:39: unknown key \"subdivide\"; did you mean \"subdivide_to\"? known: file, "
      "package, normals, up, fit_height, subdivide_to in mesh");
}

TEST_F(MeshFile, TheSameFileInTwoFinenessesIsTwoMeshes) {
  file("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string text = R"(schema: 1
scene: two
camera: {position: [0, 0, -3], look_at: [0, 0, 0], vertical_fov_deg: 40}
materials: {grey: {albedo: 0.5}}
objects:
  - {name: coarse, mesh: {file: a.obj}, material: grey}
  - {name: fine, mesh: {file: a.obj, subdivide_to: 7}, material: grey}
)";
  const Scene scene = tests::parse(text, folder_.path()).at_frame(0);
  EXPECT_EQ(scene.objects[0].mesh->triangles.size(), 1U);
  EXPECT_GE(scene.objects[1].mesh->triangles.size(), 7U);
}

}  // namespace
}  // namespace renderers::scene
