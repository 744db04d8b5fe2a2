// The whole way, on real scenes: the quick suite is run, its report opened in a real browser.
//
// With DISCERN_PICTURES=FOLDER the pictures of the report that READMEs show are written there.
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "perception/base/child_process.h"
#include "perception/image_file.h"
#include "tests/browser_session.h"
#include "tests/headless_browser.h"
#include "tests/places.h"
#include "tests/temporary_folder.h"

namespace tests {
namespace {

constexpr std::chrono::minutes kLongest{10};

base::CommandResult run_quick(const std::filesystem::path& results) {
  return base::run_command({tests::kProgram, "run", "quick", "--json", "--results", results},
                           kLongest);
}

/// The record of a method in a scene.
nlohmann::json record_of(const std::filesystem::path& run, const std::string& scene,
                         const std::string& method) {
  std::ifstream lines(run / "cells.jsonl");
  for (std::string line; std::getline(lines, line);) {
    const auto record = nlohmann::json::parse(line);
    if (record["scene"] == scene && record["method"] == method) return record;
  }
  return {};
}

/// Opens the report and its viewer: what it knows of every image is what is stored.
void expect_stored_values(const nlohmann::json& outcome, const std::filesystem::path& profile) {
  BrowserSession browser(profile, {1280, 800, false, {}});
  browser.open(outcome["report"].get<std::string>());
  const nlohmann::json images = browser.evaluate(
      "manifest.scenes.flatMap(s => s.images.map((image, i) => ({scene: s.name, key: s.anchor, i, "
      "label: image.label, role: image.role})).filter(one => one.role === 'method'))");
  ASSERT_GE(images.size(), 9U);
  for (const nlohmann::json& image : images) {
    const auto record =
        record_of(outcome["run"].get<std::string>(), image["scene"], image["label"]);
    if (record.is_null()) continue;  // a name with its budget
    const perception::Image stored =
        perception::read_image(std::filesystem::path(outcome["run"].get<std::string>()) /
                               record["image"].get<std::string>());
    const int x = stored.width_px / 2;
    const int y = stored.height_px / 3;
    const nlohmann::json shown = browser.evaluate(fmt::format(
        "floatCache.load(sceneByKey('{}').images[{}].floats).then(image => image.pixel({}, {}))",
        image["key"].get<std::string>(), image["i"].get<int>(), x, y));
    for (int c = 0; c < 3; ++c) {
      const double value = stored.at(x, y, c);
      EXPECT_NEAR(shown[static_cast<std::size_t>(c)].get<double>(), value,
                  std::abs(value) / 2048.0 + 1e-9)
          << image;
    }
  }
  browser.evaluate("document.querySelector('img[data-group$=\"-map-1\"]').click()");
  EXPECT_TRUE(browser.wait_for("discernViewer.displays?.awaited.size === 0"));
  for (const char* key : {"v", "v", "p"}) browser.press(key);
  EXPECT_TRUE(browser.wait_for("discernViewer.displays.awaited.size === 0"));
  const char* kept = std::getenv("DISCERN_PICTURES");
  if (kept != nullptr) browser.screenshot(std::filesystem::path(kept) / "viewer.png");
  EXPECT_EQ(browser.console(), std::vector<std::string>{});
}

TEST(QuickSuite, MakesAReportThatABrowserShowsAndResumesAtOnce) {
  const TemporaryFolder folder;
  const base::CommandResult first = run_quick(folder.path());
  ASSERT_EQ(first.exit.code, 0) << first.stderr_text;
  const auto outcome = nlohmann::json::parse(first.stdout_text);
  EXPECT_GE(outcome["cells"], 9);  // 3 scenes x 3 methods
  EXPECT_EQ(outcome["failed"], 0);
  EXPECT_EQ(outcome["skipped"], 0);

  const base::CommandResult second = run_quick(folder.path());
  ASSERT_EQ(second.exit.code, 0) << second.stderr_text;
  const auto resumed = nlohmann::json::parse(second.stdout_text);
  EXPECT_EQ(resumed["run"], outcome["run"]);

  if (!has_browser()) GTEST_SKIP() << "chromium is not installed";
  const char* kept = std::getenv("DISCERN_PICTURES");
  const auto picture =
      (kept != nullptr ? std::filesystem::path(kept) : folder.path()) / "report.png";
  const base::CommandResult shown =
      browse(outcome["report"].get<std::string>(), folder.path() / "profile",
             {"--screenshot=" + picture.string(), "--force-device-scale-factor=0.5",
              "--window-size=1400,1290"});
  EXPECT_EQ(console_lines(shown.stderr_text), "");
  ASSERT_TRUE(std::filesystem::exists(picture)) << shown.stderr_text;
  EXPECT_GT(std::filesystem::file_size(picture), 20000U);
  expect_stored_values(outcome, folder.path() / "driven");
}

}  // namespace
}  // namespace tests
