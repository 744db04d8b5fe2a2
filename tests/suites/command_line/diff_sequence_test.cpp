// `discern diff` of sequences, and of several tests side by side.
#include <cmath>
#include <limits>

#include "perception/image_file.h"
#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

class DiffSequence : public ProgramTest {
 protected:
  /// Writes constant frames `<name>-0000.exr`, ... @return their pattern
  std::string write_frames(const std::string& name, const std::vector<float>& values) const {
    for (std::size_t i = 0; i < values.size(); ++i) {
      write_image(frame_name(name, i), 16, 16, values[i]);
    }
    return path(name + "-%04d.exr");
  }
  static std::string frame_name(const std::string& name, std::size_t frame) {
    return name + "-000" + std::to_string(frame) + ".exr";
  }
  /// Changes a frame that is there.
  template <typename Change>
  void change(const std::string& name, std::size_t frame, const Change& change) const {
    const std::string file = path(frame_name(name, frame));
    perception::Image image = perception::rgb_of(perception::read_image(file));
    change(image);
    write_image(frame_name(name, frame), image);
  }
};

TEST_F(DiffSequence, ScoresFramesAndWhatChangesBetweenThem) {
  const std::string r = write_frames("r", {0.5F, 0.5F, 0.5F, 0.5F});
  const std::string constant = write_frames("c", {0.6F, 0.6F, 0.6F, 0.6F});
  const std::string steps = write_frames("s", {0.5F, 0.6F, 0.5F, 0.5F});
  const auto json = discern_json(
      {"diff", r, constant, steps, "--frames", "0..3", "--metric", "mse", "--metric", "flicker"},
      "diff");
  EXPECT_EQ(json["status"], "ok");
  EXPECT_EQ(json["reference"], r);
  EXPECT_EQ(json["frames"], (nlohmann::json{0, 1, 2, 3}));
  ASSERT_EQ(json["tests"].size(), 2U);
  const auto& of_constant = json["tests"][0]["scores"];
  const auto& of_steps = json["tests"][1]["scores"];
  // A constant error is no flicker, though it is an error.
  EXPECT_NEAR(of_constant["mse"]["value"], 0.01, 1e-6);
  EXPECT_EQ(of_constant["flicker"]["value"], 0.0);
  EXPECT_NEAR(of_steps["mse"]["value"], 0.0025, 1e-6);
  EXPECT_NEAR(of_steps["mse"]["details"]["worst"], 0.01, 1e-6);
  EXPECT_EQ(of_steps["mse"]["details"]["worst_frame"], 1);
  EXPECT_NEAR(of_steps["mse"]["details"]["p95"], 0.0085, 1e-6);  // type 7: 0.85 of the way
  EXPECT_EQ(of_steps["mse"]["frames"].size(), 4U);
  // Up and down again are a change each; nothing happens after.
  const auto& flicker = of_steps["flicker"]["frames"];
  ASSERT_EQ(flicker.size(), 3U);
  EXPECT_EQ(flicker[0]["frame"], 1);
  EXPECT_GT(flicker[0]["value"], 0.1);
  EXPECT_GT(flicker[1]["value"], 0.1);
  EXPECT_EQ(flicker[2]["value"], 0.0);
  EXPECT_TRUE(flicker[0]["details"].contains("jnd_p95"));
  EXPECT_EQ(of_steps["flicker"]["unit"], "JND");
}

TEST_F(DiffSequence, PrintsATableOfMetricsAndTests) {
  const std::string r = write_frames("r", {0.5F, 0.5F});
  const std::string a = write_frames("a", {0.5F, 0.75F});
  const std::string b = write_frames("b", {0.5F, 0.5F});
  const auto result =
      discern({"diff", r, a, b, "--frames", "0..1", "--metric", "mse", "--metric", "ssim"});
  EXPECT_EQ(result.exit.code, 0) << result.stderr_text;
  const auto has = [&](const std::string& text) {
    return result.stdout_text.find(text) != std::string::npos;
  };
  EXPECT_TRUE(has("2 tests against " + r + ", frames 0 to 1 (2)\n")) << result.stdout_text;
  EXPECT_TRUE(has("metric  mean ")) << result.stdout_text;
  EXPECT_TRUE(has("mse      0.03125    0.0625      1  0.059375  squared radiance  lower "))
      << result.stdout_text;
  EXPECT_TRUE(has("lower   " + a)) << result.stdout_text;
  EXPECT_TRUE(has("lower   " + b)) << result.stdout_text;
  EXPECT_LT(result.stdout_text.find("lower   " + b), result.stdout_text.find("higher  " + a));
}

TEST_F(DiffSequence, ExposuresAreFixedOverTheSequence) {
  write_frames("r", {0.5F, 0.05F});
  write_frames("t", {0.45F, 0.045F});
  const auto exposures = [&](const std::vector<std::string>& words) {
    const auto json = discern_json(words, "diff")["scores"]["flip"];
    std::vector<double> starts;
    if (!json.contains("frames"))
      return std::vector{json["details"]["start_exposure"].get<double>()};
    for (const auto& frame : json["frames"]) starts.push_back(frame["details"]["start_exposure"]);
    EXPECT_NE(json["parameters"]["start_exposure"], "auto");
    EXPECT_NEAR(starts[0], std::stod(json["parameters"]["start_exposure"].get<std::string>()),
                1e-9);
    return starts;
  };
  const auto shared = exposures(
      {"diff", path("r-%04d.exr"), path("t-####.exr"), "--frames", "0..1", "--metric", "flip"});
  ASSERT_EQ(shared.size(), 2U);
  EXPECT_EQ(shared[0], shared[1]);
  // Alone the frames have exposures of their own.
  std::vector<double> alone;
  for (const std::size_t frame : {0U, 1U}) {
    alone.push_back(exposures({"diff", path(frame_name("r", frame)), path(frame_name("t", frame)),
                               "--metric", "flip"})[0]);
  }
  EXPECT_NEAR(alone[1] - alone[0], std::log2(10.0), 1e-4);
  EXPECT_NEAR(shared[0], alone[0], 1e-4);
  const auto text = discern(
      {"diff", path("r-%04d.exr"), path("t-%04d.exr"), "--frames", "0..1", "--metric", "flip"});
  EXPECT_NE(text.stdout_text.find("flip: start_exposure="), std::string::npos) << text.stdout_text;
  EXPECT_NE(text.stdout_text.find("for all frames, found from the references\n"),
            std::string::npos);
}

TEST_F(DiffSequence, DefaultsToFlickerToo) {
  const std::string r = write_frames("r", {0.5F, 0.5F});
  EXPECT_EQ(discern_json({"diff", r, r, "--frames", "0..1"}, "diff")["scores"].size(), 4U);
  const auto one = discern_json({"diff", r, r, "--frames", "1"}, "diff");
  EXPECT_EQ(one["scores"].size(), 3U);
  EXPECT_EQ(one["scores"]["ssim"]["frames"].size(), 1U);
}

TEST_F(DiffSequence, RegionAndMaskSelectPixelsOfEveryFrame) {
  const std::string r = write_frames("r", {0.5F, 0.5F});
  const std::string t = write_frames("t", {0.5F, 0.5F});
  change("t", 1, [](perception::Image& image) {
    for (float& value : image.pixel(3, 5)) value = 1.0F;
  });
  const auto score = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"diff",     r,         t,          "--frames", "0..1",
                                   "--metric", "flicker", "--metric", "mse"};
    words.insert(words.end(), more.begin(), more.end());
    return discern_json(words, "diff")["scores"];
  };
  perception::Image mask = perception::make_gray_image(16, 16, "Y", {});
  mask.at(3, 5) = 1.0F;
  const std::string here = write_image("here.exr", mask);
  for (float& value : mask.pixels) value = 1.0F - value;
  const std::string elsewhere = write_image("elsewhere.exr", mask);
  const double whole = score({})["flicker"]["value"];
  EXPECT_GT(whole, 0.0);
  EXPECT_GT(score({"--mask", here})["flicker"]["value"], 100.0 * whole);
  EXPECT_EQ(score({"--mask", elsewhere})["flicker"]["value"], 0.0);
  EXPECT_GT(score({"--region", "3,5,1,1"})["flicker"]["value"], whole);
  EXPECT_EQ(score({"--region", "8,8,4,4"})["flicker"]["value"], 0.0);
  EXPECT_NEAR(score({"--region", "3,5,1,1"})["mse"]["value"], 0.125, 1e-6);
}

TEST_F(DiffSequence, ANonFinitePixelFailsUnlessIgnored) {
  const std::string r = write_frames("r", {0.5F, 0.5F, 0.5F});
  const std::string t = write_frames("t", {0.75F, 0.75F, 0.75F});
  change("t", 1, [](perception::Image& image) {
    image.at(4, 2, 1) = std::numeric_limits<float>::quiet_NaN();
  });
  const std::vector<std::string> words{"diff",     r,     t,          "--frames", "0..2",
                                       "--metric", "mse", "--metric", "flicker"};
  const auto json = discern_json(words, "diff", 3);
  EXPECT_EQ(json["status"], "non_finite");
  EXPECT_EQ(json["reason"], "1 non-finite pixels in " + t + ", the first in frame 1 at (4, 2)");
  EXPECT_EQ(json["non_finite"]["test"]["first_frame"], 1);
  EXPECT_EQ(json["scores"]["mse"]["value"], nullptr);
  EXPECT_NEAR(json["scores"]["mse"]["details"]["worst"], 0.0625, 1e-6);
  EXPECT_EQ(json["scores"]["mse"]["frames"][1]["text"], "n/a");
  EXPECT_EQ(json["scores"]["flicker"]["frames"][1]["value"], nullptr);
  std::vector<std::string> ignoring = words;
  ignoring.emplace_back("--ignore-non-finite");
  const auto rest = discern_json(ignoring, "diff");
  EXPECT_EQ(rest["status"], "ok");
  EXPECT_NEAR(rest["scores"]["mse"]["value"], 0.0625, 1e-6);
  EXPECT_EQ(rest["scores"]["flicker"]["value"], 0.0);
}

TEST_F(DiffSequence, LimitsAreOnTheMeanTheWorstFrameAndTheP95) {
  const std::string r = write_frames("r", {0.5F, 0.5F});
  const std::string t = write_frames("t", {0.5F, 0.75F});
  const auto code = [&](const std::string& limit) {
    return discern({"diff", r, t, "--frames", "0..1", "--metric", "mse", "--metric", "flicker",
                    "--fail-above", limit})
        .exit.code;
  };
  EXPECT_EQ(code("mse=0.04"), 0);
  EXPECT_EQ(code("mse=0.03"), 1);
  EXPECT_EQ(code("mse.worst=0.06"), 1);
  EXPECT_EQ(code("mse.worst=0.07"), 0);
  EXPECT_EQ(code("mse.p95=0.05"), 1);
  EXPECT_EQ(code("flicker=0.1"), 1);
  EXPECT_EQ(code("flicker=1000"), 0);
}

TEST_F(DiffSequence, MapsAreWrittenOfEveryFrame) {
  const std::string r = write_frames("r", {0.5F, 0.5F});
  const std::string t = write_frames("t", {0.5F, 0.75F});
  const auto json = discern_json({"diff", r, t, "--frames", "0..1", "--metric", "mse", "--metric",
                                  "flicker", "--map-dir", path("maps")},
                                 "diff");
  EXPECT_EQ(json["scores"]["mse"]["frames"][1]["map"], path("maps/t-0001.mse.exr"));
  EXPECT_NEAR(perception::read_image(path("maps/t-0001.mse.exr")).at(7, 7), 0.0625, 1e-6);
  EXPECT_TRUE(std::filesystem::exists(path("maps/t-0000.mse.png")));
  EXPECT_TRUE(std::filesystem::exists(path("maps/t-0001.flicker.exr")));
  EXPECT_FALSE(std::filesystem::exists(path("maps/t-0000.flicker.exr")));
  EXPECT_EQ(json["scores"]["mse"]["map"], nullptr);
}

TEST_F(DiffSequence, RefusesWhatIsNoSequence) {
  const std::string r = write_frames("r", {0.5F, 0.5F});
  const std::string image = path("r-0000.exr");
  expect_refused({"diff", image, image, "--metric", "flicker"},
                 "--metric: \"flicker\" scores sequences; accepted: with --frames FIRST..LAST and "
                 "file names that hold %04d or ####, or an image metric");
  expect_refused({"diff", r, r},
                 r + ": no such file; if it names the files of a sequence, add --frames "
                     "FIRST..LAST");
  expect_refused({"diff", r, r, "--frames", "0..2"},
                 path("r-0002.exr") + ": no such file; --frames names it");
  expect_refused({"diff", r, r, "--frames", "0", "--metric", "flicker"},
                 "--frames: 1 frame; metric \"flicker\" accepts 2 or more");
  expect_refused({"diff", r, image, "--frames", "0..1"},
                 "test: \"" + image +
                     "\" has no places for the frame number; accepted with --frames: one, written "
                     "%d, %04d or ####");
  expect_refused({"diff", r, r, "--frames", "0..1", "--at", "2,3"},
                 "--at: tells a pixel of single images; accepted: without --frames, on the files "
                 "of one frame");
  write_image("r-0001.exr", 8, 16, 0.5F);
  expect_refused({"diff", r, r, "--frames", "0..1"},
                 path("r-0001.exr") + ": is 8x16 pixels, but the reference " + image +
                     " is 16x16; both must have the same size");
}

TEST_F(DiffSequence, SeveralImagesStandSideBySide) {
  const std::string r = write_image("r.exr", 16, 16, 0.5F);
  const std::string a = write_image("a.exr", 16, 16, 0.75F);
  const std::string b = write_image("b.exr", 16, 16, 0.5F);
  const auto result =
      discern({"diff", r, a, b, "--metric", "mse", "--metric", "psnr", "--at", "2,3"});
  EXPECT_EQ(result.exit.code, 0) << result.stderr_text;
  const std::string blanks(a.size() - 4, ' ');
  const std::string table = "2 tests against " + r + "\n" + "test" + blanks +
                            "  mse ↓             psnr ↑\n" + blanks +
                            "      squared radiance  dB\n";
  const auto has = [&](const std::string& text) {
    return result.stdout_text.find(text) != std::string::npos;
  };
  EXPECT_TRUE(has(table)) << result.stdout_text;
  EXPECT_TRUE(has(a + "            0.0625  ")) << result.stdout_text;
  EXPECT_TRUE(has(b + "                 0  inf\n")) << result.stdout_text;
  EXPECT_TRUE(has("\n" + a + "\n")) << result.stdout_text;
  EXPECT_TRUE(has("maps at 2,3: mse 0.0625, psnr ")) << result.stdout_text;
  EXPECT_FALSE(has("a.exr against")) << result.stdout_text;
}

}  // namespace
}  // namespace tests
