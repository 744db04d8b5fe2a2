#include <algorithm>
#include <cmath>

#include "perception/image_file.h"
#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

class RenderVerb : public ProgramTest {
 protected:
  std::vector<std::string> words(const std::vector<std::string>& more) const {
    std::vector<std::string> all{"render",     "--scene", "cornell-box-spot",
                                 "--renderer", "path",    "--size",
                                 "24x16",      "--out",   path("a.exr")};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

TEST_F(RenderVerb, WritesImageAndRecord) {
  const auto json =
      discern_json(words({"--samples", "4", "--seed", "7", "--threads", "1"}), "render");
  EXPECT_EQ(json["status"], "ok");
  EXPECT_EQ(json["scene"], "cornell-box-spot");
  EXPECT_EQ(json["size_px"], (nlohmann::json{24, 16}));
  EXPECT_EQ(json["samples"], 4);
  EXPECT_EQ(json["parameters"]["samples"], 4);
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["threads"], 1);
  EXPECT_EQ(json["image"], path("a.exr"));
  const perception::ImageFile file = perception::read_image_file(path("a.exr"));
  EXPECT_EQ(perception::pixel_hash(file.parts.front().image), json["pixel_hash"]);
  EXPECT_GT(file.parts.size(), 1U);
  EXPECT_EQ(file.attributes.text.at(perception::kEncodingAttribute), "scene_linear");
  EXPECT_EQ(file.attributes.number.at(perception::kLuminanceScaleAttribute), 100.0);
}

TEST_F(RenderVerb, WhatARendererPrintsStaysOutOfTheData) {
  const auto json =
      discern_json({"render", "--scene", "cornell-box-spot", "--renderer", "blank", "--size", "8x8",
                    "--out", path("b.exr"), "--set", "behaviour=print"},
                   "render");
  EXPECT_EQ(json["status"], "ok");
}

TEST_F(RenderVerb, SettingSamplesMeansTheBudget) {
  const auto by_option = discern_json(words({"--samples", "4"}), "render");
  const auto by_setting = discern_json(words({"--set", "samples=4"}), "render");
  EXPECT_EQ(by_setting["samples"], 4);
  EXPECT_EQ(by_setting["pixel_hash"], by_option["pixel_hash"]);
  EXPECT_EQ(discern_json(words({"--set", "samples=4", "--samples", "4"}), "render")["samples"], 4);
  expect_refused(words({"--set", "samples=4", "--samples", "5"}),
                 "--samples 5 and --set samples=4 disagree; give one");
  expect_refused(words({"--set", "samples=4", "--time", "1s"}),
                 "--time: cannot be given together with a number of samples");
}

TEST_F(RenderVerb, CropsEveryPartOfTheImage) {
  discern_json(words({"--samples", "4"}), "render");
  const perception::Image whole = perception::read_image(path("a.exr"));
  const auto json = discern_json(words({"--samples", "4", "--crop", "5,3,8,6"}), "render");
  EXPECT_EQ(json["crop_px"], (nlohmann::json{5, 3, 8, 6}));
  const perception::ImageFile part = perception::read_image_file(path("a.exr"));
  for (const perception::NamedImage& image : part.parts) EXPECT_EQ(image.image.width_px, 8);
  EXPECT_EQ(part.parts.front().image.pixels, perception::crop(whole, 5, 3, 8, 6).pixels);
  expect_refused(words({"--samples", "4", "--crop", "20,0,8,6"}),
                 "--crop: the rectangle 20,0,8,6 is empty or leaves the image of 24x16 pixels");
}

TEST_F(RenderVerb, WritesOneAov) {
  discern_json(words({"--samples", "4", "--aov", "normal"}), "render");
  const perception::ImageFile file = perception::read_image_file(path("a.exr"));
  ASSERT_EQ(file.parts.size(), 1U);
  EXPECT_EQ(file.parts.front().name, "normal");
  std::filesystem::remove(path("a.exr"));
  const auto result = discern(words({"--samples", "4", "--aov", "norml"}));
  EXPECT_EQ(result.exit.code, 2);
  EXPECT_EQ(result.stderr_text.find("discern: error: --aov: unknown AOV of this renderer "
                                    "\"norml\"; did you mean \"normal\"?"),
            0U);
  EXPECT_FALSE(std::filesystem::exists(path("a.exr")));
}

TEST_F(RenderVerb, APngIsTheSrgbPictureAtTheExposure) {
  std::vector<std::string> png = words({"--samples", "4", "--exposure", "-1"});
  std::replace(png.begin(), png.end(), path("a.exr"), path("a.png"));
  discern_json(png, "render");
  discern_json(words({"--samples", "4"}), "render");
  const perception::Image linear = perception::read_image(path("a.exr"));
  const perception::Image picture = perception::read_image(path("a.png"));
  ASSERT_EQ(picture.encoding, perception::Encoding::display);
  for (std::size_t i = 0; i < linear.pixels.size(); ++i) {
    // IEC 61966-2-1, written out again here.
    const float value = std::clamp(0.5F * linear.pixels[i], 0.0F, 1.0F);
    const float encoded =
        value <= 0.0031308F ? 12.92F * value : 1.055F * std::pow(value, 1.0F / 2.4F) - 0.055F;
    EXPECT_NEAR(picture.pixels[i], encoded, 0.51F / 255.0F);
  }
}

TEST_F(RenderVerb, PrintsTimesAndStagesForAPerson) {
  const auto result = discern(words({"--samples", "2"}));
  EXPECT_EQ(result.exit.code, 0);
  for (const char* part : {"cornell-box-spot  path (best)", "24x16", "2 samples", "total ",
                           "unattributed", "image "}) {
    EXPECT_NE(result.stdout_text.find(part), std::string::npos) << part << result.stdout_text;
  }
}

TEST_F(RenderVerb, ANonFiniteImageIsWrittenAndSaid) {
  const std::string scene = write_text("bright.yaml", R"(schema: 1
scene: bright
camera: {position: [0, 0, -2], look_at: [0, 0, 0], vertical_fov_deg: 40}
materials: {lamp: {emission: [3.0e38, 3.0e38, 3.0e38], albedo: [0.9, 0.9, 0.9]}}
objects: [{name: room, box: {min: [-3, -3, -3], max: [3, 3, 3], facing: in}, material: lamp}]
)");
  const auto json = discern_json({"render", "--scene", scene, "--renderer", "path", "--size", "8x8",
                                  "--samples", "8", "--out", path("a.exr")},
                                 "render", 3);
  EXPECT_EQ(json["status"], "non_finite");
  EXPECT_GT(json["non_finite_pixels"].get<int>(), 0);
  EXPECT_NE(json["reason"], nullptr);
  EXPECT_TRUE(std::filesystem::exists(path("a.exr")));
}

TEST_F(RenderVerb, FailureIsOneJsonObject) {
  const auto json = discern_json(words({"--preset", "bst"}), "error", 2);
  EXPECT_EQ(json["status"], "error");
  EXPECT_EQ(json["exit_code"], 2);
  EXPECT_NE(json["reason"].get<std::string>().find("\"bst\""), std::string::npos);
  EXPECT_EQ(discern_json({"render", "--nonsense"}, "error", 2)["exit_code"], 2);
}

TEST_F(RenderVerb, NothingIsLeftBesideTheImage) {
  discern(words({"--samples", "1"}));
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder())) ++files;
  EXPECT_EQ(files, 1U);
}

}  // namespace
}  // namespace tests
