#pragma once

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "perception/image_file.h"
#include "results/html_report/html_report.h"
#include "tests/browser_session.h"
#include "tests/headless_browser.h"
#include "tests/results/viewer_run.h"
#include "tests/temporary_folder.h"

namespace test_results {

inline int srgb_byte(double linear) {
  const double encoded =
      linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
  return static_cast<int>(std::lround(255.0 * encoded));
}

struct Color {
  int r = 0;
  int g = 0;
  int b = 0;
};

/// A report in a browser. With DISCERN_SCREENSHOTS=FOLDER pictures are left there to look at.
class ReportViewer : public testing::Test {
 protected:
  void SetUp() override {
    if (!tests::has_browser()) GTEST_SKIP() << "chromium is not installed";
  }

  void TearDown() override {
    if (!browser_) return;
    EXPECT_EQ(browser_->console(), std::vector<std::string>{});
  }

  /// Writes the report of the run of known pixels and opens it.
  void open_page(const tests::BrowserSession::Options& options = {}, const std::string& hash = "",
                 results::html_report::ReportOptions report = {}) {
    const std::filesystem::path run = write_viewer_run(folder_.path());
    page_ = results::html_report::write_report(results::load_run(run), report).index;
    browser_ = std::make_unique<tests::BrowserSession>(folder_.path() / "profile", options);
    browser_->open(page_, hash);
  }

  /// Clicks on a picture of the page and waits for the floats of what is shown.
  void open_picture(const std::string& group, int image, const std::string& more = "") {
    const nlohmann::json box = browser_->evaluate(
        "(() => { const e = document.querySelector('img[data-group=\"" + group +
        "\"][data-image=\"" + std::to_string(image) + "\"]" + more +
        "'); e.scrollIntoView({block: 'center'}); const b = e.getBoundingClientRect(); return [b.x "
        "+ b.width / 2, b.y + b.height / 2]; })()");
    browser_->click(box[0], box[1]);
    ASSERT_TRUE(browser_->wait_for("document.querySelector('.viewer').open"));
    settle();
  }

  /// Waits until everything that was asked for is decoded and drawn.
  void settle() {
    EXPECT_TRUE(
        browser_->wait_for("!discernViewer.displays || discernViewer.displays.awaited.size === 0"));
    browser_->evaluate(
        "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))");
    EXPECT_TRUE(
        browser_->wait_for("!discernViewer.displays || discernViewer.displays.awaited.size === 0"));
  }

  void press(const std::string& key, tests::Held held = tests::Held::none) {
    browser_->press(key, held);
    settle();
  }

  nlohmann::json state(const std::string& field) {
    return browser_->evaluate("discernViewer.state." + field);
  }

  std::string text_of(const std::string& selector) {
    return browser_->evaluate("document.querySelector('" + selector + "').textContent");
  }

  /// Middle of a pixel of the scene in the window, in a pane.
  nlohmann::json place_of(double x, double y, int pane = 0) {
    return browser_->evaluate("(() => { const v = discernViewer, p = v.placeIn(v.paneBoxes()[" +
                              std::to_string(pane) +
                              "]), s = v.stage.getBoundingClientRect(); return [s.x + p.x + (" +
                              std::to_string(x) + " + 0.5) * v.state.zoom, s.y + p.y + (" +
                              std::to_string(y) + " + 0.5) * v.state.zoom]; })()");
  }

  /// What is seen of a pixel, beside the numbers that may stand in its middle.
  Color seen(double x, double y, int pane = 0) {
    const std::filesystem::path path = folder_.path() / "seen.png";
    browser_->screenshot(path);
    const perception::Image image = perception::read_image(path);
    const nlohmann::json place = place_of(x - 0.4, y - 0.4, pane);
    const auto at = [&](int c) {
      return static_cast<int>(std::lround(255.0F * image.at(place[0], place[1], c)));
    };
    return {at(0), at(1), at(2)};
  }

  void expect_seen(double x, double y, Color wanted, int tolerance = 1, int pane = 0) {
    const Color color = seen(x, y, pane);
    EXPECT_NEAR(color.r, wanted.r, tolerance) << x << "," << y;
    EXPECT_NEAR(color.g, wanted.g, tolerance) << x << "," << y;
    EXPECT_NEAR(color.b, wanted.b, tolerance) << x << "," << y;
  }

  void expect_gray(double x, double y, int byte) { expect_seen(x, y, {byte, byte, byte}); }

  /// The colour of a value on the scale of a mode.
  Color color_of(const std::string& mode, double value) {
    const nlohmann::json color = browser_->evaluate(
        "(() => { const m = discernViewer.state.scene.mode('" + mode +
        "'), t = m.table; const p = "
        "scalePosition(" +
        std::to_string(value) +
        ", m.scale, t === 'signed'); return "
        "[...colorTables[t].subarray(4 * Math.floor(p * 255 + 0.5)).slice(0, 3)]; })()");
    return {color[0], color[1], color[2]};
  }

  void keep_screenshot(const std::string& name) {
    const char* kept = std::getenv("DISCERN_SCREENSHOTS");
    if (kept != nullptr) browser_->screenshot(std::filesystem::path(kept) / (name + ".png"));
  }

  tests::TemporaryFolder folder_;
  std::filesystem::path page_;
  std::unique_ptr<tests::BrowserSession> browser_;
};

}  // namespace test_results
