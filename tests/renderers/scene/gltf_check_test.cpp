#include "renderers/scene/gltf_check.h"

#include "tests/renderers/scene/mesh_file_fixture.h"

#include <glm/geometric.hpp>

namespace renderers::scene {
namespace {

using Gltf = MeshFile;

/// One triangle as a binary glTF file.
std::string small_glb() {
  std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,)"
      R"("scale":[1,1,-1]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
      R"("min":[0,0,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],)"
      R"("buffers":[{"byteLength":36}]})";
  while (json.size() % 4 != 0) json += ' ';
  const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::string bytes = "glTF";
  append_u32(bytes, 2);
  append_u32(bytes, 12 + 8 + json.size() + 8 + sizeof(positions));
  append_u32(bytes, json.size());
  bytes += "JSON" + json;
  append_u32(bytes, sizeof(positions));
  bytes += std::string("BIN\0", 4);
  bytes.append(reinterpret_cast<const char*>(positions), sizeof(positions));
  return bytes;
}

TEST_F(Gltf, ReadsGlbAndKeepsTheFrontOfAMirroredNode) {
  const Mesh mesh = read(file("a.glb", small_glb()));
  ASSERT_EQ(mesh.triangles.size(), 1U);
  const auto t = mesh.triangles[0];
  // The triangle's front is +z in the file; mirrored in z it must be -z.
  EXPECT_LT(glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                       mesh.positions[t.z] - mesh.positions[t.x])
                .z,
            0.0F);
}

TEST_F(Gltf, TruncatedGlbIsRefused) {
  const std::string whole = small_glb();
  for (const std::size_t cut : {1U, 10U, 40U, 200U}) {
    EXPECT_NE(error_of("a.glb", whole.substr(0, whole.size() - cut)).find("truncated"),
              std::string::npos)
        << cut;
  }
  EXPECT_EQ(error_of("a.glb", "nothing of the kind"),
            "a.glb: not a GLB file: it must begin with glTF");
}

/// JSON of two triangles on four vertices. The buffer holds 4 bytes of padding, the positions (48
/// bytes), 2 bytes of padding and the indices, whose accessor skips 2 bytes of its view.
std::string indexed_json(unsigned component_type, const std::string& buffer) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[)"
         R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],)"
         R"("max":[1,1,0]},{"bufferView":1,"byteOffset":4,"componentType":)" +
         std::to_string(component_type) +
         R"(,"count":6,"type":"SCALAR"}],"bufferViews":[{"buffer":0,"byteOffset":4,)"
         R"("byteLength":48},{"buffer":0,"byteOffset":52,"byteLength":28}],"buffers":[{)" +
         buffer + R"("byteLength":80}]})";
}

/// The 80 bytes for it: two triangles, the fifth index (face 1) is the given one.
std::string indexed_buffer(std::size_t index_bytes, std::size_t fifth) {
  const float positions[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
  std::string bytes(4, '\xFF');
  bytes.append(reinterpret_cast<const char*>(positions), sizeof(positions));
  bytes.append(4, '\xFF');
  for (const std::size_t index :
       {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{1}, fifth, std::size_t{2}}) {
    std::string four;
    append_u32(four, index);
    bytes += four.substr(0, index_bytes);
  }
  bytes.resize(80, '\xFF');
  return bytes;
}

std::string indexed_glb(std::string json, const std::string& buffer) {
  while (json.size() % 4 != 0) json += ' ';
  std::string bytes = "glTF";
  append_u32(bytes, 2);
  append_u32(bytes, 12 + 8 + json.size() + 8 + buffer.size());
  append_u32(bytes, json.size());
  bytes += "JSON" + json;
  append_u32(bytes, buffer.size());
  return bytes + std::string("BIN\0", 4) + buffer;
}

constexpr const char* kFive = "mesh 0, primitive 0: face 1 names vertex 5; the primitive has 4";

TEST_F(Gltf, GlbIndicesOutOfRangeAreRefused) {
  for (const auto& [type, index_bytes] : {std::pair{5121U, 1U}, {5123U, 2U}, {5125U, 4U}}) {
    const std::string json = indexed_json(type, "");
    const auto good = file("a.glb", indexed_glb(json, indexed_buffer(index_bytes, 3)));
    EXPECT_EQ(read(good).triangles.size(), 2U) << type;
    EXPECT_EQ(error_of("a.glb", indexed_glb(json, indexed_buffer(index_bytes, 5))),
              std::string("a.glb: ") + kFive);
    // One more than the last vertex.
    EXPECT_NE(error_of("a.glb", indexed_glb(json, indexed_buffer(index_bytes, 4))), "no error");
  }
}

TEST_F(Gltf, IndicesOfExternalBuffersAreChecked) {
  const std::string json = indexed_json(5123, R"("uri":"a.bin",)");
  file("a.bin", indexed_buffer(2, 3));
  EXPECT_EQ(read(file("a.gltf", json)).triangles.size(), 2U);
  file("a.bin", indexed_buffer(2, 5));
  EXPECT_EQ(error_of("a.gltf", json), std::string("a.gltf: ") + kFive);
  file("a.bin", indexed_buffer(2, 3).substr(0, 60));
  EXPECT_EQ(error_of("a.gltf", json),
            "a.gltf: mesh 0, primitive 0: truncated: bytes 52 + 28 of a buffer that has 60");
}

/// RFC 4648, Sec. 4.
std::string base64(const std::string& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      const char byte = i + j < bytes.size() ? bytes[i + j] : '\0';
      bits = (bits << 8U) | static_cast<unsigned char>(byte);
    }
    for (unsigned j = 0; j < 4; ++j) text += digits[(bits >> (18U - 6U * j)) & 63U];
  }
  const std::size_t padding = (3 - bytes.size() % 3) % 3;
  return text.replace(text.size() - padding, padding, padding, '=');
}

TEST_F(Gltf, IndicesOfDataUrisAreChecked) {
  const std::string start = R"("uri":"data:application/octet-stream;base64,)";
  const auto json = [&](std::size_t fifth) {
    return indexed_json(5123, start + base64(indexed_buffer(2, fifth)) + "\",");
  };
  EXPECT_EQ(read(file("a.gltf", json(3))).triangles.size(), 2U);
  EXPECT_EQ(error_of("a.gltf", json(5)), std::string("a.gltf: ") + kFive);
  EXPECT_EQ(error_of("a.gltf", indexed_json(5123, start + "?!\",")),
            "a.gltf: mesh 0, primitive 0: buffer 0: its data URI is not base64");
}

TEST_F(Gltf, BadAccessorsAreRefused) {
  const std::string buffer = indexed_buffer(2, 3);
  const std::string json = indexed_json(5123, "");
  const auto error = [&](const std::string& from, const std::string& to) {
    return error_of("a.glb", indexed_glb(tests::with(json, from, to), buffer));
  };
  const std::string where = "a.glb: mesh 0, primitive 0: ";
  EXPECT_EQ(error("5123", "5126"),
            where + "indices of componentType 5126; accepted: 5121, 5123, 5125");
  EXPECT_EQ(error("\"count\":6", "\"count\":600"),
            where + "the 600 indices do not fit into their bufferView");
  EXPECT_EQ(error("\"byteOffset\":52", "\"byteOffset\":-4"),
            where + "byteOffset is -4; accepted: whole numbers from 0");
  EXPECT_EQ(error("\"2.0\"", "\"1.0\""), "a.glb: glTF version \"1.0\"; accepted: 2.x");
  EXPECT_TRUE(error("\"indices\":1", "\"indices\":9").starts_with("a.glb: not glTF 2.0: "));
}

}  // namespace
}  // namespace renderers::scene
