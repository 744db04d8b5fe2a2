#include "renderers/scene/texture_reader.h"

#include "perception/image_file.h"
#include "tests/expect_input_error.h"
#include "tests/renderers/scene/scene_text.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

namespace renderers::scene {
namespace {

Texture read(const char* text, const std::filesystem::path& folder = {}) {
  return read_texture(base::parse_document(text, "t.yaml"), "t", folder);
}

TEST(Checker, HasTilesAlongEachSide) {
  const Texture texture = read("{checker: {a: 0.9, b: [0.1, 0.2, 0.3], tiles: 4}}");
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const glm::vec2 uv((static_cast<float>(i) + 0.5F) / 4.0F,
                         1.0F - (static_cast<float>(j) + 0.5F) / 4.0F);
      EXPECT_FLOAT_EQ(sample_texture(texture, uv).x, (i + j) % 2 == 0 ? 0.9F : 0.1F);
    }
  }
}

TEST(Stripes, RunUpwards) {
  const Texture texture = read("{stripes: {a: 1, b: 0, count: 2}}");
  for (const float v : {0.1F, 0.5F, 0.9F}) {
    EXPECT_FLOAT_EQ(sample_texture(texture, {0.25F, v}).x, 1.0F);
    EXPECT_FLOAT_EQ(sample_texture(texture, {0.75F, v}).x, 0.0F);
  }
}

TEST(Noise, IsSeededAndStaysBetweenItsColours) {
  const Texture one = read("{noise: {a: 0.2, b: 0.6, cells: 8, seed: 1}}");
  const Texture again = read("{noise: {a: 0.2, b: 0.6, cells: 8, seed: 1}}");
  const Texture other = read("{noise: {a: 0.2, b: 0.6, cells: 8, seed: 2}}");
  EXPECT_EQ(one.image.pixels, again.image.pixels);
  EXPECT_NE(one.image.pixels, other.image.pixels);
  double sum = 0.0;
  for (const float value : one.image.pixels) {
    ASSERT_GE(value, 0.2F);
    ASSERT_LE(value, 0.6F);
    sum += static_cast<double>(value);
  }
  EXPECT_NEAR(sum / static_cast<double>(one.image.pixels.size()), 0.4, 0.05);
}

TEST(TextureFile, DisplayEncodedFilesAreDecoded) {
  const tests::TemporaryFolder folder;
  auto image = perception::make_rgb_image(1, 1, perception::Encoding::display);
  for (float& value : image.pixels) value = 0.5F;
  perception::write_exr(folder.path() / "a.exr", {{{"radiance", image}}, {}});
  // IEC 61966-2-1: 0.5 decodes to 0.21404.
  EXPECT_NEAR(read("{file: a.exr}", folder.path()).image.pixels[0], 0.21404F, 1e-5F);
}

TEST(TextureFile, NegativePixelsAreRefused) {
  const tests::TemporaryFolder folder;
  auto image = perception::make_rgb_image(2, 1, perception::Encoding::scene_linear);
  image.at(1, 0, 0) = -1.0F;
  const auto path = folder.path() / "a.exr";
  perception::write_exr(path, {{{"radiance", image}}, {}});
  EXPECT_EQ(tests::input_error_of([&] { read("{file: a.exr}", folder.path()); }),
            "t.yaml:1:1: " + path.string() + ": pixel (1, 0) is -1; accepted: finite and >= 0");
}

TEST(TextureFile, UnreadableFileIsNamedWithItsLine) {
  const tests::TemporaryFolder folder;
  const auto path = folder.path() / "a.png";
  // A PNG that ends after its signature.
  tests::write(path, "\x89PNG\r\n\x1a\n");
  const std::string message = tests::input_error_of([&] { read("{file: a.png}", folder.path()); });
  EXPECT_TRUE(message.starts_with("t.yaml:1:1: " + path.string())) << message;
}

TEST(TextureFile, MissingFileIsNamed) {
  EXPECT_EQ(tests::input_error_of([] { read("{file: gone.png}", "/nowhere"); }),
            "t.yaml:1:8: gone.png: not found (looked for /nowhere/gone.png)");
}

TEST(TextureReader, UnknownKeysAreRefused) {
  EXPECT_NE(tests::input_error_of([] { read("{checker: {a: 1, b: 0, tiles: 2}, file: x.png}"); }),
            "no error");
  EXPECT_EQ(tests::input_error_of([] { read("{checker: {a: 1, b: 0, tiles: 0}}"); }),
            "t.yaml:1:31: tiles 0 is outside [1, 128]");
}

}  // namespace
}  // namespace renderers::scene
