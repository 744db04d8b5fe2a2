#include "renderers/opengl/program.h"

#include <array>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "perception/base/errors.h"
#include "tests/expect_error.h"
#include "tests/renderers/opengl/platform_test.h"

namespace renderers::opengl {
namespace {

constexpr std::array kFiles{
    ShaderFile{"test/scale.comp.glsl", R"(#include "test/factor.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 3) readonly buffer Inputs { uint inputs[]; };
layout(std430, binding = 4) writeonly buffer Outputs { uint outputs[]; };
uniform uint count;
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < count) outputs[i] = factor(inputs[i]) + OFFSET;
}
)"},
    ShaderFile{"test/factor.glsl", "uint factor(uint x) { return 3u * x; }\n"},
    ShaderFile{"test/broken.comp.glsl", R"(#include "test/factor.glsl"
layout(local_size_x = 1) in;

#include "test/broken.glsl"
void main() {}
)"},
    ShaderFile{"test/broken.glsl", "// a comment\nfloat half_of(float x) { return y / 2.0; }\n"},
    ShaderFile{"test/late.comp.glsl", R"(#include "test/factor.glsl"
layout(local_size_x = 1) in;
void main() { undeclared(); }
)"},
    ShaderFile{"test/uniforms.comp.glsl", R"(layout(local_size_x = 1) in;
layout(std430, binding = 0) writeonly buffer Outputs { float outputs[]; };
uniform int i;
uniform uint u;
uniform float f;
uniform ivec2 i2;
uniform vec2 f2;
uniform vec3 f3;
uniform vec4 f4;
uniform mat4 m;
uniform float unused;
void main() {
  outputs[0] = float(i);
  outputs[1] = float(u);
  outputs[2] = f;
  outputs[3] = float(i2.x - i2.y);
  outputs[4] = f2.x - f2.y;
  outputs[5] = f3.x - f3.z;
  outputs[6] = f4.y - f4.w;
  outputs[7] = (m * vec4(1.0, 2.0, 3.0, 1.0)).y;
}
)"},
    ShaderFile{"test/images.comp.glsl", R"(layout(local_size_x = 4, local_size_y = 4) in;
layout(binding = 1) uniform sampler2DArray inputs;
layout(binding = 2, rgba32f) writeonly uniform image2DArray outputs;
void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(at, imageSize(outputs)))) return;
  imageStore(outputs, at, 2.0 * texelFetch(inputs, at, 0) + float(at.z));
}
)"}};

ProgramSource source_of(const std::string& path, Defines defines = {}) {
  return {kFiles, {path}, std::move(defines)};
}

class ProgramGlTest : public PlatformTest {};
INSTANTIATE_TEST_SUITE_P(Platforms, ProgramGlTest, all_platforms(), platform_label);

TEST_P(ProgramGlTest, ComputesWithBuffersUniformsAndDefines) {
  constexpr std::uint32_t kCount = 1000;
  std::vector<std::uint32_t> numbers(kCount);
  for (std::uint32_t i = 0; i < kCount; ++i) numbers[i] = i * i;
  const Buffer inputs = Buffer::of(context_, std::span<const std::uint32_t>(numbers));
  Buffer outputs(context_, kCount * sizeof(std::uint32_t));
  Program& program = context_->program(source_of("test/scale.comp.glsl", {{"OFFSET", "7u"}}));
  program.set("count", kCount);
  program.storage(3, inputs);
  program.storage(4, outputs);
  program.dispatch(groups_for(kCount, 64));
  const auto results = outputs.read<std::uint32_t>(kCount);
  for (std::uint32_t i = 0; i < kCount; ++i) EXPECT_EQ(results[i], 3 * i * i + 7) << i;
}

TEST_P(ProgramGlTest, IsCompiledOncePerSourceAndDefines) {
  Program& seven = context_->program(source_of("test/scale.comp.glsl", {{"OFFSET", "7u"}}));
  Program& eight = context_->program(source_of("test/scale.comp.glsl", {{"OFFSET", "8u"}}));
  EXPECT_NE(&seven, &eight);
  EXPECT_EQ(&seven, &context_->program(source_of("test/scale.comp.glsl", {{"OFFSET", "7u"}})));
}

TEST_P(ProgramGlTest, SetsUniformsOfEveryType) {
  Buffer outputs(context_, 8 * sizeof(float));
  Program& program = context_->program(source_of("test/uniforms.comp.glsl"));
  program.set("i", -5);
  program.set("u", 4000000000U);
  program.set("f", 0.25F);
  program.set("i2", glm::ivec2(9, 2));
  program.set("f2", glm::vec2(1.5F, 0.25F));
  program.set("f3", glm::vec3(5.0F, 0.0F, 0.5F));
  program.set("f4", glm::vec4(0.0F, 3.0F, 0.0F, 0.75F));
  glm::mat4 matrix(0.0F);
  matrix[2][1] = 4.0F;  // column 2, row 1
  matrix[3][1] = 0.5F;
  program.set("m", matrix);
  program.set("unused", 1.0F);
  program.storage(0, outputs);
  program.dispatch(1);
  const std::vector<float> expected{-5.0F, 4e9F, 0.25F, 7.0F, 1.25F, 4.5F, 2.25F, 12.5F};
  EXPECT_EQ(outputs.read<float>(8), expected);
}

TEST_P(ProgramGlTest, BindsEveryLayerOfAnImage) {
  const TextureShape shape{TextureFormat::rgba32f, 5, 3, 4};
  Texture inputs(context_, shape);
  Texture outputs(context_, shape);
  std::vector<float> values(5 * 3 * 4 * 4);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = 0.5F * static_cast<float>(i);
  inputs.write(values);
  Program& program = context_->program(source_of("test/images.comp.glsl"));
  program.sampler(1, inputs);
  program.image(2, outputs, Access::write);
  program.dispatch(groups_for(5, 4), groups_for(3, 4), 4);
  const std::vector<float> results = outputs.read();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto layer = static_cast<float>(i / (5 * 3 * 4));
    EXPECT_EQ(results[i], 2.0F * values[i] + layer) << i;
  }
}

TEST_P(ProgramGlTest, NamesFileAndLineOfAnErrorInAnIncludedFile) {
  tests::expect_error_with<base::DeviceError>(
      [&] { context_->program(source_of("test/broken.comp.glsl")); },
      {"shader test/broken.comp.glsl does not compile:\n", "test/broken.glsl:2", "y"});
}

TEST_P(ProgramGlTest, NamesTheLineOfAnErrorBelowAnInclude) {
  tests::expect_error_with<base::DeviceError>(
      [&] { context_->program(source_of("test/late.comp.glsl")); },
      {"shader test/late.comp.glsl does not compile:\n", "test/late.comp.glsl:3", "undeclared"});
}

TEST(GroupsFor, CoverAllItems) {
  EXPECT_EQ(groups_for(0, 64), 0U);
  EXPECT_EQ(groups_for(1, 64), 1U);
  EXPECT_EQ(groups_for(64, 64), 1U);
  EXPECT_EQ(groups_for(65, 64), 2U);
}

}  // namespace
}  // namespace renderers::opengl
