#include "renderers/opengl/framebuffer.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "renderers/opengl/buffer.h"
#include "renderers/opengl/program.h"
#include "tests/renderers/opengl/platform_test.h"

namespace renderers::opengl {
namespace {

constexpr std::array kFiles{
    // A triangle that covers everything, at depth 0.25, 0.5 ... by instance.
    ShaderFile{"test/cover.vert.glsl", R"(
layout(location = 0) flat out uint vertex_instance;
void main() {
  vec2 corner = vec2(gl_VertexID % 3 == 1 ? 3.0 : -1.0, gl_VertexID % 3 == 2 ? 3.0 : -1.0);
  vertex_instance = uint(gl_InstanceID);
  gl_Position = vec4(corner, 0.25 * float(1 + gl_InstanceID), 1.0);
#ifdef CUTS
  gl_ClipDistance[0] = corner.x;
#endif
}
)"},
    ShaderFile{"test/layers.geom.glsl", R"(
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
layout(location = 0) flat in uint vertex_instance[];
layout(location = 0) flat out uint instance;
void main() {
  for (int i = 0; i < 3; ++i) {
    instance = vertex_instance[0];
    gl_Layer = int(vertex_instance[0]);
    gl_Position = gl_in[i].gl_Position;
    EmitVertex();
  }
}
)"},
    ShaderFile{"test/write.frag.glsl", R"(
layout(location = 0) flat in uint vertex_instance;
layout(location = 0) out uint value;
void main() { value = 10u + vertex_instance; }
)"},
    ShaderFile{"test/store.frag.glsl", R"(
layout(location = 0) flat in uint instance;
layout(r32ui, binding = 0) uniform uimage2DArray counts;
void main() {
  imageAtomicAdd(counts, ivec3(ivec2(gl_FragCoord.xy), gl_Layer), 10u + instance);
}
)"}};

constexpr std::uint32_t kClear = 7;

class FramebufferGlTest : public PlatformTest {};
INSTANTIATE_TEST_SUITE_P(Platforms, FramebufferGlTest, all_platforms(), platform_label);

Texture words(const std::shared_ptr<Context>& context, int size_px, int layers) {
  Texture texture(context, {.format = TextureFormat::r32ui,
                            .width_px = size_px,
                            .height_px = size_px,
                            .layers = layers});
  texture.clear_words(kClear);
  return texture;
}

TEST_P(FramebufferGlTest, DrawsWithDepthIntoTheViewport) {
  const Texture color = words(context_, 4, 0);
  Texture depth(context_, {.format = TextureFormat::depth32f, .width_px = 4, .height_px = 4});
  depth.clear({0.0F, 0.0F, 0.0F, 0.0F});
  const Framebuffer target(context_, &color, &depth);
  Program& program = context_->program({kFiles, {"test/cover.vert.glsl", "test/write.frag.glsl"}});
  {
    RasterPass pass(target, DepthTest::nearer, 0);
    pass.viewport({1, 0}, {2, 2});
    program.draw_triangles(0, 3, 3);
    program.draw_triangles(0, 3);  // farther than what is there
  }
  EXPECT_EQ(color.read_words(),
            (std::vector<std::uint32_t>{7, 12, 12, 7, 7, 12, 12, 7, 7, 7, 7, 7, 7, 7, 7, 7}));
}

/// That a pass without clip distances ignores those a shader writes cannot be tested: llvmpipe 22.3
/// cuts at them all the same.
TEST_P(FramebufferGlTest, CutsAtClipDistances) {
  const Texture color = words(context_, 2, 0);
  const Framebuffer target(context_, &color, nullptr);
  Program& program = context_->program(
      {kFiles, {"test/cover.vert.glsl", "test/write.frag.glsl"}, {{"CUTS", "1"}}});
  const RasterPass pass(target, DepthTest::none, 1);
  program.draw_triangles(0, 3);
  EXPECT_EQ(color.read_words(), (std::vector<std::uint32_t>{7, 10, 7, 10}));
}

TEST_P(FramebufferGlTest, DrawsWhatTheDeviceCounted) {
  const Texture color = words(context_, 1, 0);
  const Framebuffer target(context_, &color, nullptr);
  const std::vector<DrawCommand> commands{{3, 2, 0, 0}, {0, 1, 0, 0}, {3, 1, 0, 0}};
  const Buffer buffer = Buffer::of(context_, std::span<const DrawCommand>(commands));
  Program& program = context_->program({kFiles, {"test/cover.vert.glsl", "test/write.frag.glsl"}});
  const RasterPass pass(target, DepthTest::none, 0);
  program.draw_triangles(buffer, 1);
  EXPECT_EQ(color.read_words().front(), kClear);
  program.draw_triangles(buffer, 0);
  EXPECT_EQ(color.read_words().front(), 11U);
  program.draw_triangles(buffer, 2);
  EXPECT_EQ(color.read_words().front(), 10U);
}

TEST_P(FramebufferGlTest, GeometryShadersChooseLayersOfNothing) {
  const Texture color = words(context_, 2, 3);
  const Framebuffer target(context_, {2, 2}, 3);
  Program& program = context_->program(
      {kFiles, {"test/cover.vert.glsl", "test/layers.geom.glsl", "test/store.frag.glsl"}});
  program.image(0, color, Access::read_write);
  const RasterPass pass(target, DepthTest::none, 0);
  program.draw_triangles(0, 3, 3);
  EXPECT_EQ(color.read_words(),
            (std::vector<std::uint32_t>{17, 17, 17, 17, 18, 18, 18, 18, 19, 19, 19, 19}));
}

}  // namespace
}  // namespace renderers::opengl
