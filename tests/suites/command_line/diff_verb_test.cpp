#include <cmath>
#include <fstream>
#include <limits>

#include "perception/image_file.h"
#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

using DiffVerb = ProgramTest;

TEST_F(DiffVerb, ScoresFollowTheirFormulas) {
  const std::string reference = write_image("r.exr", 16, 16, 0.5F);
  const std::string test = write_image("t.exr", 16, 16, 0.75F);
  const auto json = discern_json({"diff", reference, test, "--metric", "mse", "--metric", "relmse",
                                  "--metric", "relmse,trim=0.1"},
                                 "diff");
  EXPECT_EQ(json["status"], "ok");
  EXPECT_EQ(json["test"], test);
  EXPECT_NEAR(json["scores"]["mse"]["value"], 0.0625, 1e-7);
  EXPECT_NEAR(json["scores"]["relmse"]["value"], 0.0625 / (0.25 + 0.01), 1e-6);
  EXPECT_NEAR(json["scores"]["relmse,trim=0.1"]["parameters"]["trim"], 0.1, 1e-12);
}

TEST_F(DiffVerb, DefaultsToThreeMetricsAndTheStatedViewing) {
  const std::string image = write_image("r.exr", 16, 16, 0.5F);
  const auto json = discern_json({"diff", image, image}, "diff");
  EXPECT_EQ(json["scores"].size(), 3U);
  EXPECT_EQ(json["scores"]["flip"]["value"], 0.0);
  EXPECT_NEAR(json["scores"]["ssim"]["value"], 1.0, 1e-9);
  EXPECT_NEAR(json["viewing"]["ppd"], 67.0206, 1e-4);
  EXPECT_EQ(json["viewing"]["luminance_scale_cd_m2"], 100.0);
  EXPECT_EQ(json["viewing"]["origins"]["luminance_scale_cd_m2"], "default");
}

TEST_F(DiffVerb, ViewingConditionsSayWhereTheyCameFrom) {
  perception::ImageFile file;
  file.parts.push_back({"radiance", perception::make_rgb_image(16, 16, {})});
  file.attributes.number["whiteLuminance"] = 250.0;
  perception::write_exr(path("r.exr"), file);
  const auto by_white = discern_json({"diff", path("r.exr"), path("r.exr"), "--ppd", "30"}, "diff");
  EXPECT_EQ(by_white["viewing"]["ppd"], 30.0);
  EXPECT_EQ(by_white["viewing"]["origins"]["ppd"], "option");
  EXPECT_EQ(by_white["viewing"]["luminance_scale_cd_m2"], 250.0);
  EXPECT_EQ(by_white["viewing"]["origins"]["luminance_scale_cd_m2"], "file (whiteLuminance)");

  file.attributes.number[perception::kLuminanceScaleAttribute] = 80.0;
  perception::write_exr(path("r.exr"), file);
  const auto by_own = discern_json({"diff", path("r.exr"), path("r.exr")}, "diff");
  EXPECT_EQ(by_own["viewing"]["luminance_scale_cd_m2"], 80.0);
  const auto by_option = discern_json(
      {"diff", path("r.exr"), path("r.exr"), "--luminance-scale", "10", "--display", "standard_4k"},
      "diff");
  EXPECT_EQ(by_option["viewing"]["luminance_scale_cd_m2"], 10.0);
  EXPECT_EQ(by_option["viewing"]["origins"]["display"], "preset");
}

TEST_F(DiffVerb, SeveralTestsShareOneObject) {
  const std::string r = write_image("r.exr", 16, 16, 0.5F);
  const std::string a = write_image("a.exr", 16, 16, 0.5F);
  const std::string b = write_image("b.exr", 16, 16, 0.6F);
  const auto json = discern_json({"diff", r, a, b, "--metric", "mae"}, "diff");
  ASSERT_EQ(json["tests"].size(), 2U);
  EXPECT_EQ(json["tests"][0]["scores"]["mae"]["value"], 0.0);
  EXPECT_NEAR(json["tests"][1]["scores"]["mae"]["value"], 0.1, 1e-6);
}

TEST_F(DiffVerb, RegionAndMaskSelectPixels) {
  const std::string r = write_image("r.exr", 16, 16, 0.0F);
  perception::Image image = perception::make_rgb_image(16, 16, {});
  for (float& value : image.pixel(3, 5)) value = 1.0F;
  const std::string t = write_image("t.exr", image);
  const auto score = [&](std::vector<std::string> more) {
    std::vector<std::string> words{"diff", r, t, "--metric", "mse"};
    words.insert(words.end(), more.begin(), more.end());
    return discern_json(words, "diff")["scores"]["mse"]["value"].get<double>();
  };
  EXPECT_NEAR(score({}), 1.0 / 256.0, 1e-9);
  EXPECT_NEAR(score({"--region", "3,5,1,1"}), 1.0, 1e-9);
  EXPECT_NEAR(score({"--region", "0,0,3,16"}), 0.0, 1e-9);
  perception::Image mask = perception::make_gray_image(16, 16, "Y", {});
  mask.at(3, 5) = 1.0F;
  mask.at(4, 5) = 1.0F;
  const std::string m = write_image("m.exr", mask);
  EXPECT_NEAR(score({"--mask", m}), 0.5, 1e-9);
  EXPECT_NEAR(score({"--mask", m, "--region", "3,5,1,1"}), 1.0, 1e-9);
  mask.at(9, 8) = 0.5F;
  write_image("m.exr", mask);
  expect_refused({"diff", r, t, "--mask", m},
                 m + ": pixel (9, 8) is 0.5; a mask holds 0 (black) and 1 (white) only");
}

TEST_F(DiffVerb, MapsAreWrittenAndRead) {
  const std::string r = write_image("r.exr", 16, 16, 0.5F);
  const std::string t = write_image("t.exr", 16, 16, 0.75F);
  const auto json = discern_json({"diff", r, t, "--metric", "mse", "--metric", "smape,trim=0.1",
                                  "--map-dir", path("maps"), "--at", "2,3"},
                                 "diff");
  EXPECT_EQ(json["scores"]["mse"]["map"], path("maps/t.mse.exr"));
  const perception::ImageFile map = perception::read_image_file(path("maps/t.mse.exr"));
  EXPECT_NEAR(map.parts.front().image.at(7, 7), 0.0625, 1e-6);
  EXPECT_EQ(map.attributes.text.at("discern:metric"), "mse");
  EXPECT_TRUE(std::filesystem::exists(path("maps/t.mse.png")));
  EXPECT_TRUE(std::filesystem::exists(path("maps/t.smape-trim-0.1.exr")));
  EXPECT_EQ(json["at"]["test"], (nlohmann::json{0.75, 0.75, 0.75}));
  EXPECT_NEAR(json["at"]["maps"]["mse"], 0.0625, 1e-6);
}

TEST_F(DiffVerb, ANonFinitePixelIsCountedLocatedAndFails) {
  const std::string r = write_image("r.exr", 16, 16, 0.5F);
  perception::Image image = perception::make_rgb_image(16, 16, {});
  image.at(4, 2, 1) = std::numeric_limits<float>::quiet_NaN();
  image.at(9, 9, 0) = std::numeric_limits<float>::infinity();
  const std::string t = write_image("t.exr", image);
  const auto json =
      discern_json({"diff", r, t, "--metric", "mse", "--region", "1,1,15,15"}, "diff", 3);
  EXPECT_EQ(json["status"], "non_finite");
  EXPECT_EQ(json["scores"]["mse"]["value"], nullptr);
  EXPECT_EQ(json["scores"]["mse"]["text"], "n/a");
  EXPECT_EQ(json["non_finite"]["test"]["pixels"], 2);
  EXPECT_EQ(json["non_finite"]["test"]["first_px"], (nlohmann::json{4, 2}));
  EXPECT_EQ(json["non_finite"]["reference"]["pixels"], 0);
  EXPECT_EQ(json["reason"], "2 non-finite pixels in " + t + ", the first at (4, 2)");
  const auto text = discern({"diff", r, t, "--metric", "mse"});
  EXPECT_EQ(text.exit.code, 3);
  EXPECT_NE(text.stdout_text.find("n/a"), std::string::npos);

  const auto rest = discern_json({"diff", r, t, "--metric", "mse", "--ignore-non-finite"}, "diff");
  EXPECT_EQ(rest["status"], "ok");
  EXPECT_NEAR(rest["scores"]["mse"]["value"], 0.25, 1e-6);
  EXPECT_EQ(rest["scores"]["mse"]["non_finite_pixels"], 2);
}

TEST_F(DiffVerb, LimitsDecideTheExitCode) {
  const std::string r = write_image("r.exr", 16, 16, 0.5F);
  const std::string t = write_image("t.exr", 16, 16, 0.75F);
  const auto code = [&](const std::string& option, const std::string& limit) {
    return discern({"diff", r, t, "--metric", "mse", "--metric", "psnr", option, limit}).exit.code;
  };
  EXPECT_EQ(code("--fail-above", "mse=0.06"), 1);
  EXPECT_EQ(code("--fail-above", "mse=0.07"), 0);
  EXPECT_EQ(code("--fail-below", "psnr=200"), 1);
  EXPECT_EQ(code("--fail-below", "psnr=1"), 0);
  const auto json =
      discern_json({"diff", r, t, "--metric", "mse", "--fail-above", "mse=0.06"}, "diff", 1);
  EXPECT_EQ(json["violated"], nlohmann::json{"mse=0.06"});
  expect_refused({"diff", r, t, "--metric", "psnr", "--fail-above", "psnr=20"},
                 "--fail-above: psnr is better when higher; use --fail-below psnr=20");
  expect_refused({"diff", r, t, "--metric", "mse", "--fail-above", "mae=20"},
                 "--fail-above: unknown metric of this diff \"mae\"; did you mean \"mse\"? known: "
                 "mse");
  expect_refused({"diff", r, t, "--metric", "mse", "--fail-above", "mse"},
                 "--fail-above: \"mse\" is not a limit; accepted: METRIC=V, such as flip=0.1");
}

TEST_F(DiffVerb, AGateMayNameADetail) {
  const std::string r = write_image("r.exr", 16, 16, 0.5F);
  const std::string t = write_image("t.exr", 16, 16, 0.75F);
  EXPECT_EQ(
      discern({"diff", r, t, "--metric", "flip", "--fail-above", "flip.maximum=0.0001"}).exit.code,
      1);
  EXPECT_EQ(
      discern({"diff", r, t, "--metric", "flip", "--fail-above", "flip.maximum=1.1"}).exit.code, 0);
  const auto unknown =
      discern({"diff", r, t, "--metric", "flip", "--fail-above", "flip.maximun=0.1"});
  EXPECT_EQ(unknown.exit.code, 2);
  EXPECT_NE(unknown.stderr_text.find("did you mean \"maximum\"?"), std::string::npos);
}

TEST_F(DiffVerb, AnInfiniteScoreIsNullWithItsText) {
  const std::string image = write_image("r.exr", 16, 16, 0.5F);
  const auto json = discern_json({"diff", image, image, "--metric", "psnr"}, "diff");
  EXPECT_EQ(json["status"], "ok");
  EXPECT_EQ(json["scores"]["psnr"]["value"], nullptr);
  EXPECT_EQ(json["scores"]["psnr"]["text"], "inf");
}

TEST_F(DiffVerb, RefusesSizesThatDiffer) {
  const std::string r = write_image("r.exr", 16, 16, 0.5F);
  const std::string t = write_image("t.exr", 16, 8, 0.5F);
  expect_refused({"diff", r, t}, t + ": is 16x8 pixels, but the reference " + r +
                                     " is 16x16; both must have the same size");
}

TEST_F(DiffVerb, RefusesFilesThatAreMissingOrTruncated) {
  const std::string r = write_image("r.exr", 64, 64, 0.5F);
  const auto missing = discern({"diff", r, path("none.exr")});
  EXPECT_EQ(missing.exit.code, 2);
  EXPECT_NE(missing.stderr_text.find(path("none.exr")), std::string::npos) << missing.stderr_text;
  const std::string t = write_image("t.exr", 64, 64, 0.25F);
  std::filesystem::resize_file(t, std::filesystem::file_size(t) / 2);
  const auto truncated = discern({"diff", r, t});
  EXPECT_EQ(truncated.exit.code, 2);
  EXPECT_NE(truncated.stderr_text.find(t), std::string::npos) << truncated.stderr_text;
}

}  // namespace
}  // namespace tests
