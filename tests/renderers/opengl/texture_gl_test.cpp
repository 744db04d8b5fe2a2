#include "renderers/opengl/texture.h"

#include <cmath>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "tests/expect_error.h"
#include "tests/renderers/opengl/platform_test.h"

namespace renderers::opengl {
namespace {

class TextureGlTest : public PlatformTest {};
INSTANTIATE_TEST_SUITE_P(Platforms, TextureGlTest, all_platforms(), platform_label);

/// A format, its channels and bytes, and the largest error of a value in [-1, 1].
struct FormatCase {
  TextureFormat format;
  std::size_t channels;
  std::int64_t texel_bytes;
  float tolerance;
};

/// Half floats have 11 significant bits and drivers may cut the rest off; so may
/// they with the steps of 8-bit snorm, 1/127.
const std::vector<FormatCase> kFloatFormats{
    {TextureFormat::r16f, 1, 2, 0x1p-11F},
    {TextureFormat::r32f, 1, 4, 0.0F},
    {TextureFormat::rgba8_snorm, 4, 4, 1.0F / 127.0F + 1e-6F},
    {TextureFormat::rgba16f, 4, 8, 0x1p-11F},
    {TextureFormat::rgba32f, 4, 16, 0.0F},
    {TextureFormat::depth32f, 1, 4, 0.0F}};

/// Different everywhere; depth holds [0, 1] only.
std::vector<float> test_values(std::size_t count, bool is_depth) {
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float unit = std::fmod(0.618034F * static_cast<float>(i), 1.0F);
    values[i] = is_depth ? unit : 2.0F * unit - 1.0F;
  }
  return values;
}

void expect_close(const std::vector<float>& values, const std::vector<float>& expected,
                  float tolerance) {
  ASSERT_EQ(values.size(), expected.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_NEAR(values[i], expected[i], tolerance) << i;
  }
}

TEST_P(TextureGlTest, EveryFormatHoldsWhatWasWritten) {
  for (const FormatCase& each : kFloatFormats) {
    for (const int layers : {0, 3}) {
      SCOPED_TRACE(fmt::format("format {}, {} layers", static_cast<int>(each.format), layers));
      const TextureShape shape{each.format, 7, 5, layers};
      const std::size_t layer_values = 7 * 5 * each.channels;
      const std::vector<float> values =
          test_values(layer_values * static_cast<std::size_t>(std::max(1, layers)),
                      each.format == TextureFormat::depth32f);
      Texture texture(context_, shape);
      texture.write(values);
      expect_close(texture.read(), values, each.tolerance);
      EXPECT_EQ(size_bytes_of(shape), 35 * std::max(1, layers) * each.texel_bytes);
      if (layers == 0) continue;
      const auto begin = values.begin() + static_cast<std::ptrdiff_t>(layer_values);
      const std::vector<float> second(begin, begin + static_cast<std::ptrdiff_t>(layer_values));
      expect_close(texture.read(0, 1), second, each.tolerance);
    }
  }
}

TEST_P(TextureGlTest, ClearsEveryFormatLevelAndLayer) {
  for (const FormatCase& each : kFloatFormats) {
    SCOPED_TRACE(static_cast<int>(each.format));
    Texture texture(context_, {each.format, 6, 4, 2, 3});
    texture.clear({0.25F, 0.5F, 0.75F, 1.0F});
    const std::vector<float> rgba{0.25F, 0.5F, 0.75F, 1.0F};
    const std::vector<std::size_t> texels{24, 6, 1};
    for (int level = 0; level < 3; ++level) {
      const std::vector<float> values = texture.read(level);
      ASSERT_EQ(values.size(), texels[static_cast<std::size_t>(level)] * 2 * each.channels);
      for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_NEAR(values[i], rgba[i % each.channels], each.tolerance) << level << " " << i;
      }
    }
  }
}

TEST_P(TextureGlTest, WordsKeepTheirBits) {
  Texture texture(context_, {TextureFormat::r32ui, 3, 2, 4});
  texture.clear_words(0x7F800000U);  // the bits of infinity
  EXPECT_EQ(texture.read_words(), std::vector<std::uint32_t>(24, 0x7F800000U));
  EXPECT_EQ(texture.read_words(3), std::vector<std::uint32_t>(6, 0x7F800000U));
}

TEST_P(TextureGlTest, RowsComeBackInTheirOrder) {
  Texture texture(context_, {TextureFormat::r32f, 2, 3});
  const std::vector<float> rows{1, 2, 3, 4, 5, 6};
  texture.write(rows);
  EXPECT_EQ(texture.read(), rows);
}

TEST_P(TextureGlTest, SizeCountsAllLevels) {
  EXPECT_EQ(size_bytes_of({TextureFormat::r32f, 8, 4, 0, 4}), 4 * (32 + 8 + 2 + 1));
  EXPECT_EQ(size_bytes_of({TextureFormat::rgba16f, 5, 1, 3, 2}), 8 * 3 * (5 + 2));
}

TEST_P(TextureGlTest, ReshapeKeepsTheSameShape) {
  Texture texture;
  EXPECT_TRUE(texture.is_empty());
  const TextureShape shape{TextureFormat::r32f, 4, 4};
  texture.reshape(context_, shape);
  const std::vector<float> values(16, 3.0F);
  texture.write(values);
  texture.reshape(context_, shape);
  EXPECT_EQ(texture.read(), values);
  texture.reshape(context_, {TextureFormat::r32f, 4, 5});
  EXPECT_EQ(texture.shape().height_px, 5);
}

TEST_P(TextureGlTest, RefusesSizesBeyondTheLimits) {
  const auto size_px = static_cast<int>(context_->limits().texture_size_px);
  const auto layers = static_cast<int>(context_->limits().array_layers);
  const std::string& renderer = context_->facts().renderer;
  tests::expect_error<UnsupportedError>(
      [&] {
        Texture(context_, {TextureFormat::r32f, 4, size_px + 1});
      },
      fmt::format("a texture of 4 x {} is needed; {} allows {} a side", size_px + 1, renderer,
                  size_px));
  tests::expect_error<UnsupportedError>(
      [&] {
        Texture(context_, {TextureFormat::r32f, 4, 4, layers + 1});
      },
      fmt::format("a texture of 4 x 4, {} layers is needed; {} allows {} layers", layers + 1,
                  renderer, layers));
}

}  // namespace
}  // namespace renderers::opengl
