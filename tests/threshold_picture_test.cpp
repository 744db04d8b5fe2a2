// What `discern thresholds` says of a rendered floor: texture raises thresholds, and the map's
// pictures can be looked at.
//
// With DISCERN_PICTURES=FOLDER the picture that perception/README.md shows is written there.
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "perception/base/child_process.h"
#include "perception/image_file.h"
#include "tests/headless_browser.h"
#include "tests/places.h"
#include "tests/temporary_folder.h"

namespace tests {
namespace {

constexpr std::chrono::minutes kLongest{10};

void run(const std::vector<std::string>& words) {
  std::vector<std::string> command{tests::kProgram};
  command.insert(command.end(), words.begin(), words.end());
  const base::CommandResult result = base::run_command(command, kLongest);
  ASSERT_EQ(result.exit.code, 0) << result.stderr_text;
}

/// Mean of a map over a rectangle given in parts of its size.
double mean_over(const perception::Image& map, double x0, double y0, double x1, double y1) {
  double sum = 0.0;
  int count = 0;
  for (int y = static_cast<int>(y0 * map.height_px); y < y1 * map.height_px; ++y) {
    for (int x = static_cast<int>(x0 * map.width_px); x < x1 * map.width_px; ++x) {
      sum += static_cast<double>(map.at(x, y));
      ++count;
    }
  }
  return sum / count;
}

class ThresholdPicture : public testing::Test {
 protected:
  /// Renders the floor without noise to speak of and maps its thresholds.
  void SetUp() override {
    const std::string folder = folder_.path().string();
    run({"render", "--scene", "textured-floor", "--renderer", "path", "--size", "480x300",
         "--samples", "1024", "--set", "max_depth=2", "--out", folder + "/floor.exr"});
    run({"thresholds", folder + "/floor.exr", "--masking", "rama99_calibrated", "--ppd", "40",
         "--out", folder + "/maps"});
    perception::write_png(folder_.path() / "floor.png", shown(folder_.path() / "floor.exr"));
  }

  static perception::Image shown(const std::filesystem::path& exr) {
    perception::Image image = perception::read_image(exr);
    image.encoding = perception::Encoding::display;
    for (float& value : image.pixels) {
      value = std::pow(std::min(std::max(value, 0.0F), 1.0F), 1.0F / 2.2F);
    }
    return image;
  }

  std::string page() const {
    std::string html =
        "<style>body{margin:0;background:#fff;font:15px sans-serif;display:flex}"
        "figure{margin:8px}img{width:480px;display:block}</style>";
    const std::pair<const char*, const char*> pictures[] = {
        {"floor.png", "plain, tiled and grained floor under a soft shadow"},
        {"maps/floor.elevation-2.82cpd.png", "how much more a change of 2.8 cpd may be"},
        {"maps/floor.threshold.png", "least visible change of any kind, cd/m2"}};
    for (const auto& [file, caption] : pictures) {
      html += std::string("<figure><img src=\"") + file + "\">" + caption + "</figure>";
    }
    return html;
  }

  TemporaryFolder folder_;
};

TEST_F(ThresholdPicture, TextureHidesMoreThanAPlainFloor) {
  const perception::Image elevation =
      perception::read_image(folder_.path() / "maps/floor.elevation-2.82cpd.exr");
  const double plain = mean_over(elevation, 0.05, 0.8, 0.2, 0.95);
  const double tiles = mean_over(elevation, 0.4, 0.8, 0.6, 0.95);
  const double grain = mean_over(elevation, 0.8, 0.8, 0.95, 0.95);
  EXPECT_GT(tiles, 3.0 * plain);
  EXPECT_GT(grain, 3.0 * plain);

  if (!has_browser()) GTEST_SKIP() << "chromium is not installed";
  std::ofstream(folder_.path() / "page.html") << page();
  const char* kept = std::getenv("DISCERN_PICTURES");
  const auto picture =
      (kept != nullptr ? std::filesystem::path(kept) : folder_.path()) / "thresholds.png";
  const base::CommandResult result =
      browse(folder_.path() / "page.html", folder_.path() / "profile",
             {"--screenshot=" + picture.string(), "--force-device-scale-factor=0.75",
              "--window-size=1500,400"});
  ASSERT_TRUE(std::filesystem::exists(picture)) << result.stderr_text;
  EXPECT_GT(std::filesystem::file_size(picture), 20000U);
}

}  // namespace
}  // namespace tests
