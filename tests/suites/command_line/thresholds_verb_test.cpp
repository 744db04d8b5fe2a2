#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "perception/contrast_sensitivity.h"
#include "perception/image_file.h"
#include "perception/threshold_vs_intensity.h"
#include "perception/visual_masking.h"
#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

using ThresholdsVerb = ProgramTest;

TEST_F(ThresholdsVerb, AUniformImageHasTheThresholdOfItsLuminance) {
  const std::string image = write_image("grey.exr", 64, 48, 0.5F);
  const auto json =
      discern_json({"thresholds", image, "--out", path("maps"), "--ppd", "60"}, "thresholds");
  EXPECT_EQ(json["status"], "ok");
  EXPECT_EQ(json["viewing"]["ppd"], 60.0);
  const double adaptation_cd_m2 = json["maps"]["adaptation"]["median"];
  // 0.5 x 100 cd/m2 and what the screen reflects of the room's light.
  EXPECT_GE(adaptation_cd_m2, 50.0);
  EXPECT_LT(adaptation_cd_m2, 52.0);
  const double expected =
      perception::threshold_cd_m2(perception::ThresholdCurve::ward, adaptation_cd_m2);
  EXPECT_EQ(json["masking"], "rama99_calibrated");
  const double scale = json["tvi_scale"];
  EXPECT_LT(scale, 1.0);
  EXPECT_NEAR(json["maps"]["threshold"]["max"], scale * expected, 1e-4 * expected);
  const auto literal = discern_json(
      {"thresholds", image, "--out", path("maps"), "--masking", "rama99"}, "thresholds");
  EXPECT_EQ(literal["tvi_scale"], 1.0);
  EXPECT_NEAR(literal["maps"]["threshold"]["max"], expected, 1e-4 * expected);
  EXPECT_NEAR(json["maps"]["elevation"]["max"], 1.0, 1e-6);
  for (const auto& [name, map] : json["maps"].items()) {
    const perception::Image stored = perception::read_image(map["map"].get<std::string>());
    EXPECT_EQ(stored.width_px, 64) << name;
    const perception::Image picture = perception::read_image(map["map_picture"].get<std::string>());
    EXPECT_GT(picture.height_px, 48) << name << ": the scale stands below the map";
  }
}

/// What steers the grid final gather is this model: from the preview that it stores come, to the
/// bit, the thresholds and the masking that it stores.
TEST_F(ThresholdsVerb, ReproduceWhatSteersTheGatherToTheBit) {
  const std::string frame = path("frame.exr");
  // A plate in fog: masking is at its bound beside the plate, and near 1 far away.
  const std::string scene = write_text(
      "fog.yaml",
      "schema: 1\nscene: fog\n"
      "camera: {position: [0, 0, -3], look_at: [0, 0, 0], vertical_fov_deg: 40}\n"
      "environment: {constant: [0.5, 0.5, 0.5]}\n"
      "materials: {grey: {albedo: 0.5}, lamp: {emission: [1, 1, 1]}}\nobjects:\n"
      "  - {name: plate, material: grey, quad: {origin: [3.2, -0.3, 0], edge_u: [-0.6, 0, 0], "
      "edge_v: [0, 0.6, 0]}}\n"
      "  - {name: lamp, material: lamp, quad: {origin: [3.2, 2, -1], edge_u: [0, 0, 1], edge_v: "
      "[1, 0, 0]}}\n");
  const auto rendered =
      discern({"render", "--scene", scene, "--renderer", "grid-final-gather", "--set",
               "link_budget=200", "--set", "gather_samples=16", "--set", "class_samples=16",
               "--set", "ppd=50", "--size", "128x32", "--out", frame});
  ASSERT_EQ(rendered.exit.code, 0) << rendered.stderr_text;
  // What hides edges is matched to the frequency that the eye sees best.
  const perception::MaskingSettings masking = perception::masking_profile("rama99_calibrated");
  const double edges_cpd =
      perception::csf_peak(perception::find_csf(masking.csf), masking.csf_luminance_cd_m2)
          .frequency_cpd;
  discern_json({"thresholds", frame, "--part", "preview", "--ppd", "50", "--target",
                fmt::format("{}", edges_cpd), "--out", path("maps")},
               "thresholds");
  const std::string matched = fmt::format("elevation-of-{:.4g}cpd", edges_cpd);
  const auto steering = [&](const std::string& name) {
    for (const perception::NamedImage& part : perception::read_image_file(frame).parts) {
      if (part.name == name) return part.image.pixels;
    }
    ADD_FAILURE() << "no AOV " << name;
    return std::vector<float>();
  };
  const auto made = [&](const std::string& name) {
    return perception::read_image(path("maps") + "/frame." + name + ".exr").pixels;
  };
  EXPECT_EQ(made("tvi"), steering("tvi"));
  EXPECT_EQ(made(matched), steering("masking"));
  EXPECT_LT(std::ranges::min(made(matched)), 1.5F);
  EXPECT_GT(std::ranges::max(made(matched)), 2.5F);
  EXPECT_NE(made(matched), made("elevation"));
  // The published way: all contrasts together.
  const auto literal =
      discern({"render", "--scene", scene, "--renderer", "grid-final-gather", "--set",
               "link_budget=200", "--set", "gather_samples=16", "--set", "class_samples=16",
               "--set", "ppd=50", "--set", "masked_by=all", "--size", "128x32", "--out", frame});
  ASSERT_EQ(literal.exit.code, 0) << literal.stderr_text;
  EXPECT_EQ(made("tvi"), steering("tvi"));
  EXPECT_EQ(made("elevation"), steering("masking"));
  // Of another viewer they are others.
  discern_json({"thresholds", frame, "--part", "preview", "--ppd", "20", "--out", path("maps")},
               "thresholds");
  EXPECT_NE(made("elevation"), steering("masking"));
  const auto nothing =
      discern({"thresholds", frame, "--part", "preview", "--target", "0", "--out", path("maps")});
  EXPECT_EQ(nothing.exit.code, 2);
  EXPECT_NE(nothing.stderr_text.find("--target: 0 cycles per degree; accepted: above 0"),
            std::string::npos)
      << nothing.stderr_text;
  const auto unknown = discern({"thresholds", frame, "--part", "previw", "--out", path("maps")});
  EXPECT_EQ(unknown.exit.code, 2);
  EXPECT_NE(unknown.stderr_text.find("unknown part \"previw\"; did you mean \"preview\"?"),
            std::string::npos)
      << unknown.stderr_text;
}

TEST_F(ThresholdsVerb, TextureRaisesThresholds) {
  perception::Image image = perception::make_rgb_image(96, 96, perception::Encoding::scene_linear);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const auto x = static_cast<double>(i / 3 % 96);
    image.pixels[i] = static_cast<float>(0.5 + 0.4 * std::sin(0.4 * x));
  }
  const auto json = discern_json(
      {"thresholds", write_image("bars.exr", image), "--out", path("maps")}, "thresholds");
  EXPECT_GT(json["maps"]["elevation"]["median"], 1.2);
  const auto yee = discern_json({"thresholds", path("bars.exr"), "--out", path("yee"), "--masking",
                                 "yee_compat", "--tvi", "weber"},
                                "thresholds");
  EXPECT_EQ(yee["tvi"], "weber");
  EXPECT_NE(yee["maps"]["threshold"]["median"], json["maps"]["threshold"]["median"]);
}

TEST_F(ThresholdsVerb, NonFinitePixelsAreCountedAndLocated) {
  perception::Image image = perception::make_rgb_image(32, 32, perception::Encoding::scene_linear);
  image.at(3, 7, 1) = std::numeric_limits<float>::quiet_NaN();
  const auto json = discern_json(
      {"thresholds", write_image("nan.exr", image), "--out", path("maps")}, "thresholds", 3);
  EXPECT_EQ(json["status"], "non_finite");
  EXPECT_EQ(json["reason"], "1 of 1024 pixels are not finite, the first at (3, 7)");
}

TEST_F(ThresholdsVerb, RefusesUnknownNamesWithTheKnownOnes) {
  const std::string image = write_image("grey.exr", 8, 8, 0.5F);
  const auto message_of = [&](const std::string& option, const std::string& value) {
    return discern({"thresholds", image, "--out", path("maps"), option, value}).stderr_text;
  };
  EXPECT_NE(message_of("--csf", "dali").find("did you mean \"daly\""), std::string::npos);
  EXPECT_NE(message_of("--masking", "rama").find("rama99"), std::string::npos);
  EXPECT_NE(message_of("--tvi", "wardd")
                .find("--tvi: unknown threshold curve \"wardd\"; did you mean \"ward\"?"),
            std::string::npos);
  EXPECT_NE(message_of("--ppd", "0").find("--ppd: 0; accepted: a number above 0"),
            std::string::npos);
}

}  // namespace
}  // namespace tests
