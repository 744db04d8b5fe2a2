#include "renderers/ray_bundles/device_needs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "renderers/ray_bundles/shader_files.h"

namespace renderers::ray_bundles {
namespace {

opengl::Limits limits(std::int64_t blocks, std::int64_t bytes) {
  opengl::Limits limits;
  limits.storage_blocks = blocks;
  limits.storage_block_bytes = bytes;
  limits.vertex_storage_blocks = 1;
  limits.fragment_storage_blocks = 3;
  limits.storage_bindings = 11;
  return limits;
}

TEST(DeviceNeeds, AreNamedWhereADeviceLacksThem) {
  const DeviceNeeds needs = list_needs(false, 100);
  EXPECT_EQ(lacking(needs, limits(9, 100), "toy"), "");
  EXPECT_EQ(lacking(needs, limits(8, 100), "toy"),
            "the shaders take 9 storage blocks and toy allows 8");
  EXPECT_EQ(lacking(needs, limits(9, 99), "toy"),
            "the scene takes 100 bytes and toy allows a storage block 99");
  opengl::Limits few = limits(9, 100);
  few.vertex_storage_blocks = 0;
  EXPECT_EQ(lacking(needs, few, "toy"),
            "the shaders take 1 storage blocks in the vertex stage and toy allows 0");
  EXPECT_EQ(lacking(list_needs(true, 100), few, "toy"), "");
  few = limits(9, 100);
  few.fragment_storage_blocks = 2;
  EXPECT_EQ(lacking(needs, few, "toy"),
            "the shaders take 3 storage blocks in the fragment stage and toy allows 2");
  few = limits(9, 100);
  few.storage_bindings = 10;
  EXPECT_EQ(lacking(needs, few, "toy"),
            "the shaders take 11 bindings of storage blocks and toy allows 10");
}

/// What the blocks of a shader take; includes have none.
struct Blocks {
  std::string path;
  std::int64_t count = 0;
  std::int64_t bindings = 0;  ///< 1 + the last one
};

Blocks blocks_of(const opengl::ShaderFile& file) {
  constexpr std::string_view kLayout = "layout(std430, binding = ";
  Blocks blocks{std::string(file.path), 0, 0};
  for (std::size_t at = file.text.find(kLayout); at != std::string_view::npos;
       at = file.text.find(kLayout, at + 1)) {
    ++blocks.count;
    const std::int64_t binding = std::stoll(std::string(file.text.substr(at + kLayout.size(), 3)));
    blocks.bindings = std::max(blocks.bindings, binding + 1);
  }
  return blocks;
}

/// The most of all shaders whose name ends so, but for one.
Blocks most_blocks(std::string_view ending, std::string_view other_than) {
  Blocks most;
  for (const opengl::ShaderFile& file : shader_files()) {
    const Blocks own = blocks_of(file);
    if (!file.path.ends_with(ending) || file.path.ends_with(other_than)) continue;
    most.bindings = std::max(most.bindings, own.bindings);
    if (own.count <= most.count) continue;
    most.count = own.count;
    most.path = own.path;
  }
  return most;
}

TEST(DeviceNeeds, AreThoseOfTheShaders) {
  const Blocks exchange = most_blocks(".glsl", "none");
  EXPECT_TRUE(exchange.path.ends_with("/receive_light.comp.glsl")) << exchange.path;
  EXPECT_EQ(exchange.count, kExchangeNeeds.storage_blocks);
  EXPECT_EQ(exchange.bindings, kExchangeNeeds.bindings);
  const Blocks lists = most_blocks(".glsl", "/receive_light.comp.glsl");
  EXPECT_TRUE(lists.path.ends_with("/order_lines.comp.glsl")) << lists.path;
  constexpr DeviceNeeds kDrawn = list_needs(false);
  EXPECT_EQ(lists.count, kDrawn.storage_blocks);
  EXPECT_EQ(lists.bindings, kDrawn.bindings);
  // Traced lines have no slots.
  std::int64_t traced = 0;
  for (const opengl::ShaderFile& file : shader_files()) {
    const Blocks own = blocks_of(file);
    const bool is_list = own.path.find("slots") == std::string::npos &&
                         !own.path.ends_with("/receive_light.comp.glsl");
    if (is_list) traced = std::max(traced, own.bindings);
  }
  EXPECT_EQ(traced, list_needs(true).bindings);
  EXPECT_EQ(most_blocks(".vert.glsl", "none").count, kDrawn.vertex_blocks);
  EXPECT_EQ(most_blocks(".frag.glsl", "none").count, kDrawn.fragment_blocks);
}

}  // namespace
}  // namespace renderers::ray_bundles
