#include "renderers/scene/three_ds_check.h"

#include "tests/renderers/scene/mesh_file_fixture.h"

#include <limits>

namespace renderers::scene {
namespace {

using ThreeDs = MeshFile;

std::string chunk(unsigned kind, const std::string& content) {
  std::string bytes;
  append_u16(bytes, kind);
  append_u32(bytes, content.size() + 6);
  return bytes + content;
}

/// One triangle as a 3DS file. @param z  of the last vertex, @param last  index of the last corner
std::string small_3ds(float z = 0.0F, unsigned last = 2) {
  const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, z};
  std::string vertices;
  append_u16(vertices, 3);
  vertices.append(reinterpret_cast<const char*>(positions), sizeof(positions));
  std::string faces;
  for (const unsigned value : {1U, 0U, 1U, last, 0U}) append_u16(faces, value);
  const std::string mesh = chunk(0x4100, chunk(0x4110, vertices) + chunk(0x4120, faces));
  return chunk(0x4D4D, chunk(0x3D3D, chunk(0x4000, std::string("a\0", 2) + mesh)));
}

TEST_F(ThreeDs, Reads3ds) { EXPECT_EQ(read(file("a.3ds", small_3ds())).triangles.size(), 1U); }

TEST_F(ThreeDs, Bad3dsIsRefused) {
  const std::string whole = small_3ds();
  const std::string message = error_of("a.3ds", whole.substr(0, whole.size() - 5));
  EXPECT_EQ(message, "a.3ds: truncated: needs " + std::to_string(whole.size()) + " bytes, has " +
                         std::to_string(whole.size() - 5));
  EXPECT_EQ(error_of("a.3ds", "nothing of the kind"),
            "a.3ds: not a 3DS file: it must begin with 4d4d");
  // The outer length is right, an inner one is not.
  std::string inner = whole;
  inner[8] = static_cast<char>(0xFF);
  EXPECT_NE(error_of("a.3ds", inner).find("truncated"), std::string::npos);
  EXPECT_TRUE(
      error_of("a.3ds", chunk(0x4D4D, "")).starts_with("a.3ds: cannot be read as a mesh: "));
}

TEST_F(ThreeDs, FaceIndicesOutOfRangeAreRefused) {
  EXPECT_EQ(error_of("a.3ds", small_3ds(0.0F, 3)),
            "a.3ds: object \"a\": face 0 names vertex 3; the object has 3");
  EXPECT_EQ(error_of("a.3ds", small_3ds(0.0F, 0xFFFF)),
            "a.3ds: object \"a\": face 0 names vertex 65535; the object has 3");
}

TEST_F(ThreeDs, FacesBeforeTheirVerticesAreChecked) {
  std::string faces;
  for (const unsigned value : {1U, 0U, 1U, 2U, 0U}) append_u16(faces, value);
  const std::string mesh = chunk(0x4100, chunk(0x4120, faces) + chunk(0x4110, std::string(2, 0)));
  EXPECT_EQ(error_of("a.3ds",
                     chunk(0x4D4D, chunk(0x3D3D, chunk(0x4000, "b" + std::string(1, 0) + mesh)))),
            "a.3ds: object \"b\": face 0 names vertex 0; the object has 0");
}

TEST_F(ThreeDs, FacesOfMaterialsAreChecked) {
  const auto with_material = [](unsigned face) {
    const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    std::string vertices(1, 3);
    vertices += '\0';
    vertices.append(reinterpret_cast<const char*>(positions), sizeof(positions));
    std::string faces;
    for (const unsigned value : {1U, 0U, 1U, 2U, 0U}) append_u16(faces, value);
    std::string material("m\0", 2);
    append_u16(material, 1);
    append_u16(material, face);
    const std::string mesh =
        chunk(0x4110, vertices) + chunk(0x4120, faces + chunk(0x4130, material));
    return chunk(0x4D4D, chunk(0x3D3D, chunk(0x4000, std::string("a\0", 2) + chunk(0x4100, mesh))));
  };
  EXPECT_EQ(read(file("a.3ds", with_material(0))).triangles.size(), 1U);
  EXPECT_EQ(error_of("a.3ds", with_material(1)),
            "a.3ds: object \"a\": a material names face 1; the object has 1");
}

TEST_F(ThreeDs, CoordinatesAreFinite) {
  EXPECT_EQ(error_of("a.3ds", small_3ds(std::numeric_limits<float>::quiet_NaN())),
            "a.3ds: object \"a\": vertex 2 has a value that is not finite");
}

TEST_F(ThreeDs, CountsFitTheirChunk) {
  std::string many = small_3ds();
  // The faces' count follows the header of the last chunk: 10 bytes from the end.
  many[many.size() - 10] = 2;
  EXPECT_EQ(error_of("a.3ds", many), "a.3ds: truncated: needs " + std::to_string(many.size() + 8) +
                                         " bytes, has " + std::to_string(many.size()));
}

TEST_F(ThreeDs, BytesOverwrittenAnywhereInTheFacesAreRefused) {
  const std::string whole = small_3ds();
  for (std::size_t at = 0; at < 6; at += 2) {
    std::string broken = whole;
    broken.replace(broken.size() - 8 + at, 2, "\xFF\xFF");
    EXPECT_NE(error_of("a.3ds", broken).find("names vertex 65535"), std::string::npos) << at;
  }
}

}  // namespace
}  // namespace renderers::scene
