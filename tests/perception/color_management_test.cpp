#include "perception/color_management.h"

#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

#include "perception/aces_config.h"
#include "perception/base/atomic_file.h"
#include "perception/base/errors.h"
#include "tests/expect_error.h"
#include "tests/temporary_folder.h"

namespace perception {
namespace {

/// Grey pixels 0.18, 1 and 16.
Image greys() {
  Image image = make_rgb_image(3, 1, Encoding::scene_linear);
  const float values[]{0.18F, 1.0F, 16.0F};
  for (int x = 0; x < 3; ++x) {
    for (float& value : image.pixel(x, 0)) value = values[x];
  }
  return image;
}

void expect_greys(const Image& shown, std::array<float, 3> expected) {
  EXPECT_EQ(shown.encoding, Encoding::display);
  for (int x = 0; x < 3; ++x) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(shown.at(x, 0, c), expected[static_cast<std::size_t>(x)], 2e-5F) << x << "," << c;
    }
  }
}

/// Sets $OCIO while it lives.
class OcioVariable {
 public:
  explicit OcioVariable(const std::string& value) { setenv("OCIO", value.c_str(), 1); }
  ~OcioVariable() { unsetenv("OCIO"); }
  OcioVariable(const OcioVariable&) = delete;
  OcioVariable& operator=(const OcioVariable&) = delete;
};

TEST(AcesConfig, SdrVideoValues) {
  const ColorManagement colors;
  EXPECT_EQ(colors.origin(), "embedded");
  expect_greys(colors.view(greys(), "sRGB", "ACES SDR"), {0.35595F, 0.81197F, 0.99974F});
}

TEST(AcesConfig, PqValues) {
  const ColorManagement colors;
  expect_greys(colors.view(greys(), "PQ", "ACES HDR 1000"), {0.33259F, 0.51530F, 0.69997F});
}

TEST(AcesConfig, HoldsThe16OutputTransformsAndEachWorks) {
  const ColorManagement colors;
  EXPECT_EQ(colors.default_display(), "sRGB");
  EXPECT_EQ(colors.default_view("sRGB"), "ACES SDR");
  int count = 0;
  for (const std::string& display : colors.displays()) {
    for (const std::string& view : colors.views(display)) {
      const Image shown = colors.view(greys(), display, view);
      EXPECT_EQ(count_non_finite(shown).pixels, 0U);
      EXPECT_LT(shown.at(0, 0, 1), shown.at(1, 0, 1)) << display << " " << view;
      if (view == "Raw") continue;
      EXPECT_LE(shown.at(2, 0, 1), 1.001F) << display << " " << view;
      ++count;
    }
  }
  EXPECT_EQ(count, 16);
}

TEST(AcesConfig, RawLeavesTheValues) {
  const ColorManagement colors;
  EXPECT_EQ(colors.view(greys(), "sRGB", "Raw").pixels, greys().pixels);
}

TEST(AcesConfig, ConvertsFromColorSpaces) {
  const ColorManagement colors;
  Image image = make_rgb_image(1, 1, Encoding::scene_linear);
  image.pixels = {0.2F, 0.5F, 0.9F};
  const Image same = colors.to_scene_linear_rec709(image, "Linear Rec.709");
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(same.pixels[c], image.pixels[c], 1e-5F);
  // ACES white is Rec.709 white; a Rec.709 red in ACES2065-1 is (0.43963, 0.08978, 0.01754).
  image.pixels = {0.439633F, 0.089776F, 0.017541F};
  const Image red = colors.to_scene_linear_rec709(image, "ACES2065-1");
  EXPECT_NEAR(red.pixels[0], 1.0F, 1e-5F);
  EXPECT_NEAR(red.pixels[1], 0.0F, 1e-5F);
  EXPECT_NEAR(red.pixels[2], 0.0F, 1e-5F);
}

TEST(ColorManagement, UnknownNamesAreTold) {
  const ColorManagement colors;
  tests::expect_error<base::InputError>(
      [&] { colors.view(greys(), "sRG", "ACES SDR"); },
      "unknown display \"sRG\"; did you mean \"sRGB\"? known: sRGB, PQ, "
      "P3-D65, DCI-P3");
  tests::expect_error_with<base::InputError>([&] { colors.view(greys(), "sRGB", "ACES"); },
                                             {"unknown view \"ACES\"", "known: ACES SDR, ", "Raw"});
  tests::expect_error_with<base::InputError>(
      [&] { colors.to_scene_linear_rec709(greys(), "ACEScg"); },
      {"unknown colour space \"ACEScg\"", "ACES2065-1", "Linear Rec.709"});
  EXPECT_THROW(colors.views("none"), base::InputError);
  EXPECT_THROW(colors.default_view("none"), base::InputError);
  Image shown = greys();
  shown.encoding = Encoding::display;
  tests::expect_error<base::InputError>([&] { colors.view(shown, "sRGB", "ACES SDR"); },
                                        "a view is of scene-linear images; this one is display");
}

TEST(ColorManagement, OcioVariableIsHonoured) {
  const tests::TemporaryFolder folder;
  const std::string path = (folder.path() / "config.ocio").string();
  // A studio's own: one display whose only view halves the values in ACES2065-1.
  base::write_text_file(path, R"(ocio_profile_version: 2
roles: {aces_interchange: ap0, default: ap0}
file_rules: [!<Rule> {name: Default, colorspace: default}]
displays: {Studio: [!<View> {name: Half, colorspace: half}]}
colorspaces:
  - !<ColorSpace> {name: ap0}
  - !<ColorSpace>
    name: half
    from_scene_reference: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0,
                           0, 0, 0.5, 0, 0, 0, 0, 1]}
)");
  const OcioVariable variable(path);
  const ColorManagement colors;
  EXPECT_EQ(colors.origin(), path);
  EXPECT_EQ(colors.displays(), std::vector<std::string>{"Studio"});
  expect_greys(colors.view(greys(), "Studio", "Half"), {0.09F, 0.5F, 8.0F});
}

TEST(ColorManagement, BadOcioVariablesAreInputErrors) {
  const tests::TemporaryFolder folder;
  const auto expect_bad = [&](const std::string& path, const std::string& piece) {
    const OcioVariable variable(path);
    tests::expect_error_with<base::InputError>([] { const ColorManagement colors; },
                                               {"$OCIO: " + path, piece});
  };
  expect_bad((folder.path() / "none.ocio").string(), "cannot be read");
  const std::string bad = (folder.path() / "bad.ocio").string();
  base::write_text_file(bad, "just some text");
  expect_bad(bad, "cannot be read");
  base::write_text_file(bad, R"(ocio_profile_version: 2
roles: {default: raw}
file_rules: [!<Rule> {name: Default, colorspace: default}]
displays: {D: [!<View> {name: V, colorspace: raw}]}
colorspaces: [!<ColorSpace> {name: raw}]
)");
  expect_bad(bad, "does not say which colour space is ACES2065-1");
}

}  // namespace
}  // namespace perception
