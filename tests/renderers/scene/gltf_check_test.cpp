#include "renderers/scene/gltf_check.h"

#include "tests/renderers/scene/mesh_file_fixture.h"

#include <array>

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

/// The registry's extensions that are ratified by Khronos, and the multi-vendor ones
/// (github.com/KhronosGroup/glTF, extensions/README.md; the list recalled from memory).
constexpr std::array kExtensions{"KHR_animation_pointer",
                                 "KHR_draco_mesh_compression",
                                 "KHR_lights_punctual",
                                 "KHR_materials_anisotropy",
                                 "KHR_materials_clearcoat",
                                 "KHR_materials_dispersion",
                                 "KHR_materials_emissive_strength",
                                 "KHR_materials_ior",
                                 "KHR_materials_iridescence",
                                 "KHR_materials_pbrSpecularGlossiness",
                                 "KHR_materials_sheen",
                                 "KHR_materials_specular",
                                 "KHR_materials_transmission",
                                 "KHR_materials_unlit",
                                 "KHR_materials_variants",
                                 "KHR_materials_volume",
                                 "KHR_mesh_quantization",
                                 "KHR_texture_basisu",
                                 "KHR_texture_transform",
                                 "KHR_xmp_json_ld",
                                 "EXT_lights_image_based",
                                 "EXT_mesh_gpu_instancing",
                                 "EXT_meshopt_compression",
                                 "EXT_texture_webp"};

TEST_F(Gltf, EveryExtensionThatIsRequiredIsRefusedByItsName) {
  for (const std::string name : kExtensions) {
    const std::string list = "\"" + name + "\"]";
    const std::string json =
        tests::with(indexed_json(5123, ""), "{",
                    "{\"extensionsUsed\":[" + list + ",\"extensionsRequired\":[" + list + ",");
    EXPECT_EQ(error_of("a.glb", indexed_glb(json, indexed_buffer(2, 3))),
              "a.glb: requires the glTF extension " + name +
                  "; supported: none, only what glTF 2.0 itself says of triangles is read; "
                  "accepted: the file exported without");
  }
  const std::string two =
      tests::with(indexed_json(5123, ""), "{", R"({"extensionsRequired":["VENDOR_b","VENDOR_a"],)");
  EXPECT_EQ(error_of("a.glb", indexed_glb(two, indexed_buffer(2, 3)))
                .find("a.glb: requires the glTF extensions VENDOR_a, VENDOR_b; supported: none"),
            0U);
}

TEST_F(Gltf, EveryExtensionThatIsPassedOverIsNamed) {
  const auto warnings_of = [&](const std::string& json) {
    warnings_.clear();
    EXPECT_EQ(read(file("a.glb", indexed_glb(json, indexed_buffer(2, 3)))).triangles.size(), 2U);
    return warnings_;
  };
  using Lines = std::vector<std::string>;
  const std::string plain = indexed_json(5123, "");
  EXPECT_EQ(warnings_of(plain), Lines{});
  for (const std::string name : kExtensions) {
    EXPECT_EQ(warnings_of(tests::with(plain, "{", "{\"extensionsUsed\":[\"" + name + "\"],")),
              Lines{"a.glb: passed over the glTF extension " + name + "; supported: none"});
  }
  // Used without being listed; what stands in extras is none.
  const std::string used = tests::with(
      plain, "\"indices\":1",
      R"("indices":1,"extensions":{"VENDOR_b":{}},"extras":{"extensions":{"VENDOR_c":{}}})");
  EXPECT_EQ(warnings_of(tests::with(used, "{", R"({"extensionsUsed":["VENDOR_a"],)")),
            Lines{"a.glb: passed over the glTF extensions VENDOR_a, VENDOR_b; supported: none"});
}

TEST_F(Gltf, AListOfExtensionsIsAList) {
  const std::string json = tests::with(indexed_json(5123, ""), "{", R"({"extensionsRequired":7,)");
  EXPECT_TRUE(error_of("a.glb", indexed_glb(json, indexed_buffer(2, 3)))
                  .starts_with("a.glb: not glTF 2.0: "));
}

/// The importer overflows its stack on the second one.
TEST_F(Gltf, DeepFilesAreRefused) {
  const auto nested = [](std::size_t levels) {
    const std::string value = std::string(levels, '[') + std::string(levels, ']');
    return indexed_glb(tests::with(indexed_json(5123, ""), "{", "{\"extras\":" + value + ","),
                       indexed_buffer(2, 3));
  };
  EXPECT_EQ(read(file("b.glb", nested(63))).triangles.size(), 2U);
  EXPECT_EQ(error_of("a.glb", nested(200000)),
            "a.glb: nests deeper than 64 levels; accepted: up to that");
}

}  // namespace
}  // namespace renderers::scene
