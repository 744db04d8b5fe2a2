#include "renderers/ray_bundles/device_needs.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <utility>

#include "renderers/ray_bundles/shader_files.h"

namespace renderers::ray_bundles {
namespace {

opengl::Limits limits(std::int64_t blocks, std::int64_t bytes) {
  opengl::Limits limits;
  limits.storage_blocks = blocks;
  limits.storage_block_bytes = bytes;
  return limits;
}

TEST(DeviceNeeds, AreNamedWhereADeviceLacksThem) {
  const DeviceNeeds needs{.block_bytes = 100, .storage_blocks = 9};
  EXPECT_EQ(lacking(needs, limits(9, 100), "toy"), "");
  EXPECT_EQ(lacking(needs, limits(8, 100), "toy"),
            "the shaders take 9 storage blocks and toy allows 8");
  EXPECT_EQ(lacking(needs, limits(9, 99), "toy"),
            "the scene takes 100 bytes and toy allows a storage block 99");
}

/// Blocks of the shader with most besides one, and its name; includes have none.
std::pair<std::string, std::int64_t> most_blocks(std::string_view other_than) {
  std::pair<std::string, std::int64_t> most;
  for (const opengl::ShaderFile& file : shader_files()) {
    std::int64_t count = 0;
    for (std::size_t at = file.text.find("layout(std430"); at != std::string_view::npos;
         at = file.text.find("layout(std430", at + 1)) {
      ++count;
    }
    if (count > most.second && !file.path.ends_with(other_than)) {
      most = {std::string(file.path), count};
    }
  }
  return most;
}

TEST(DeviceNeeds, AreThoseOfTheShaders) {
  const auto exchange = most_blocks("none");
  EXPECT_TRUE(exchange.first.ends_with("/receive_light.comp.glsl")) << exchange.first;
  EXPECT_EQ(exchange.second, kExchangeStorageBlocks);
  const auto lists = most_blocks("/receive_light.comp.glsl");
  EXPECT_TRUE(lists.first.ends_with("/order_lines.comp.glsl")) << lists.first;
  EXPECT_EQ(lists.second, kListStorageBlocks);
}

}  // namespace
}  // namespace renderers::ray_bundles
