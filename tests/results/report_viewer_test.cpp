// The report's viewer in a real browser, by real keys and pointer events; what is seen is read from
// screenshots. Skipped where Chromium is not installed.
#include <cmath>
#include <string>

#include "tests/results/report_viewer_fixture.h"

namespace {

using nlohmann::json;
using test_results::Color;
using test_results::srgb_byte;
using tests::BrowserSession;
using tests::Held;

class ReportViewer : public test_results::ReportViewer {};

TEST_F(ReportViewer, ShowsFloatsOfThePictureThatWasClicked) {
  open_page();
  open_picture("scene-1", 1);
  EXPECT_EQ(state("panes[0].image"), 1);
  expect_gray(0, 5, srgb_byte(0.25));
  expect_gray(8, 5, srgb_byte(0.375));
  expect_gray(15, 11, srgb_byte(0.25 + 15.0 / 64.0));
  EXPECT_NE(text_of(".viewer .head").find("2  ramp"), std::string::npos);
  EXPECT_EQ(browser_->evaluate("discernViewer.painter.name"), "WebGL2");
}

TEST_F(ReportViewer, ExposureAndToneCurvesAreWhatTheySay) {
  open_page();
  open_picture("scene-1", 0);
  press("e");
  EXPECT_EQ(state("exposure"), 0.5);
  expect_gray(4, 4, srgb_byte(0.25 * std::sqrt(2.0)));
  press("E");
  press("E");
  expect_gray(4, 4, srgb_byte(0.25 / std::sqrt(2.0)));
  press("r");
  press("t");
  EXPECT_EQ(state("curve"), "linear");
  expect_gray(4, 4, 64);
  press("t");
  EXPECT_EQ(state("curve"), "reinhard");
  expect_gray(4, 4, srgb_byte(0.25 / 1.25));
  press("t");
  EXPECT_EQ(state("curve"), "aces");
  expect_gray(4, 4, srgb_byte(0.25 * (2.51 * 0.25 + 0.03) / (0.25 * (2.43 * 0.25 + 0.59) + 0.14)));
  press("t");
  EXPECT_EQ(state("curve"), "srgb");
}

TEST_F(ReportViewer, NumberKeysSwitchAndWithShiftSetTheComparison) {
  open_page();
  open_picture("scene-1", 0);
  press("3");
  EXPECT_EQ(state("panes[0].image"), 2);
  expect_gray(8, 8, srgb_byte(0.5));
  press("2", Held::shift);
  EXPECT_EQ(state("other"), 1);
  EXPECT_EQ(state("panes[0].image"), 2);
  press("9");
  EXPECT_EQ(state("panes[0].image"), 2);  // there is no ninth
  press("ArrowRight");
  EXPECT_EQ(state("panes[0].image"), 0);
}

TEST_F(ReportViewer, DifferencesAreOnFixedScalesWithABar) {
  open_page();
  open_picture("scene-1", 1);
  const double d = 8.0 / 64.0;
  const std::vector<std::pair<std::string, double>> modes{{"signed", d},
                                                          {"absolute", d},
                                                          {"relative", d / 0.26},
                                                          {"squared", d * d},
                                                          {"relmse/full", 0.01}};
  for (const auto& [mode, value] : modes) {
    press("d");
    EXPECT_EQ(state("panes[0].mode"), mode);
    expect_seen(8, 8, color_of(mode, value), 3);
    keep_screenshot("mode-" + mode.substr(0, mode.find('/')));
  }
  EXPECT_NE(text_of(".viewer .bar-of-pane").find("logarithmic"), std::string::npos);
  press("D");
  press("D");
  EXPECT_EQ(state("panes[0].mode"), "relative");
  // Brighter pixels do not change a difference.
  const Color before = seen(8, 8);
  press("e");
  EXPECT_EQ(seen(8, 8).r, before.r);
}

TEST_F(ReportViewer, SignedDifferencesTellBrighterFromDarker) {
  open_page();
  open_picture("scene-1", 0);
  press("2", Held::shift);
  press("d");
  expect_seen(0, 4, color_of("signed", 0.0), 3);
  expect_seen(15, 4, color_of("signed", -15.0 / 64.0), 3);
  const Color darker = seen(15, 4);
  EXPECT_GT(darker.b, darker.r + 30);
}

TEST_F(ReportViewer, AnErrorMapOpensAsThatMap) {
  open_page();
  open_picture("scene-1-map-1", 1);
  EXPECT_EQ(state("panes[0].mode"), "relmse/full");
  EXPECT_EQ(state("panes[0].image"), 1);
  press("3");  // of which no map was kept
  EXPECT_NE(text_of(".viewer .head").find("no map relmse (full) of this image"), std::string::npos);
  expect_gray(8, 8, srgb_byte(0.5));
}

TEST_F(ReportViewer, PixelsThatAreNotFiniteAreCyanMarkedAndCounted) {
  open_page();
  open_picture("scene-1", 2);
  expect_seen(3, 2, {0, 255, 255});
  EXPECT_NE(text_of(".viewer .head").find("1 pixel is not finite"), std::string::npos);
  press("d");
  expect_seen(3, 2, {0, 255, 255});
  press("d");
  expect_seen(3, 2, {0, 255, 255});
  browser_->evaluate("discernViewer.change({zoom: 4})");
  settle();
  EXPECT_EQ(browser_->evaluate("discernViewer.overlay.marksDrawn"), 1);
}

TEST_F(ReportViewer, WipeFlipAndBlinkShowTheComparedImage) {
  open_page();
  open_picture("scene-1", 2);
  press("w");
  expect_gray(4, 8, srgb_byte(0.25));
  expect_gray(12, 8, srgb_byte(0.5));
  keep_screenshot("wipe");
  const json edge = place_of(7.5, 8);
  const json target = place_of(13.5, 8);
  browser_->drag(edge[0], edge[1], target[0], target[1]);
  settle();
  EXPECT_NEAR(state("wipeAt").get<double>(), 14.0 / 16.0, 0.01);
  expect_gray(12, 8, srgb_byte(0.25));
  press("w");
  browser_->key_down(" ");
  settle();
  expect_gray(12, 8, srgb_byte(0.25));
  browser_->key_up(" ");
  settle();
  expect_gray(12, 8, srgb_byte(0.5));
  press("b");
  EXPECT_TRUE(browser_->wait_for("discernViewer.blinkShowsOther"));
  EXPECT_TRUE(browser_->wait_for("!discernViewer.blinkShowsOther"));
  press("b");
  EXPECT_EQ(browser_->evaluate("discernViewer.blinkTimer === undefined"), true);
}

TEST_F(ReportViewer, LinkedViewsMoveTogetherWithoutRunningTheShader) {
  open_page();
  open_picture("scene-1", 0);
  press("v");
  press("v");
  EXPECT_EQ(state("views"), 4);
  press("p");
  EXPECT_EQ(state("active"), 1);
  press("2");
  press("d");
  EXPECT_EQ(state("panes.map(p => p.image)"), json({0, 1, 2, 1}));
  expect_seen(8, 8, color_of("signed", 8.0 / 64.0), 3, 1);
  keep_screenshot("four-views");
  const json runs = browser_->evaluate("discernViewer.painter.displayRuns");
  const json from = place_of(8, 6, 2);
  browser_->drag(from[0], from[1], from[0].get<double>() + 40, from[1].get<double>() - 20);
  browser_->wheel(from[0], from[1], -300);
  settle();
  EXPECT_GT(state("zoom"), 20);
  EXPECT_EQ(browser_->evaluate("discernViewer.painter.displayRuns"), runs);
  expect_seen(7, 6, {srgb_byte(0.25), srgb_byte(0.25), srgb_byte(0.25)}, 1, 0);
  expect_seen(7, 6, {srgb_byte(0.5), srgb_byte(0.5), srgb_byte(0.5)}, 1, 2);
  press("e");
  EXPECT_GT(browser_->evaluate("discernViewer.painter.displayRuns"), runs);
}

TEST_F(ReportViewer, ThePointUnderThePointerStaysWhenZooming) {
  open_page();
  open_picture("scene-1", 1);
  const json at = place_of(12, 3);
  browser_->wheel(at[0], at[1], -200);
  settle();
  const json after = place_of(12, 3);
  EXPECT_NEAR(after[0].get<double>(), at[0].get<double>(), 0.5);
  EXPECT_NEAR(after[1].get<double>(), at[1].get<double>(), 0.5);
}

TEST_F(ReportViewer, LargePixelsHaveTheirNumbers) {
  open_page();
  open_picture("scene-1", 1);
  browser_->evaluate("discernViewer.change({zoom: 31})");
  settle();
  EXPECT_EQ(browser_->evaluate("discernViewer.overlay.numbersDrawn"), 0);
  browser_->evaluate("discernViewer.change({zoom: 64})");
  settle();
  EXPECT_GT(browser_->evaluate("discernViewer.overlay.numbersDrawn"), 50);
  EXPECT_EQ(
      browser_->evaluate("pixelText({shown: discernViewer.displays.of(discernViewer.state, 1, "
                         "'image')}, 8, 4)"),
      json({"0.375", "0.375", "0.375"}));
  keep_screenshot("numbers");
}

TEST_F(ReportViewer, TheInspectorHasTheValuesOfAllImages) {
  open_page();
  open_picture("scene-1", 1);
  press("d");
  const json at = place_of(8, 4);
  browser_->move_to(at[0], at[1]);
  ASSERT_TRUE(browser_->wait_for(
      "document.querySelectorAll('.inspector .values > tr').length === 3 && "
      "![...document.querySelectorAll('.inspector .values td')].some(c => c.textContent === '…')"));
  EXPECT_EQ(text_of(".inspector h2"), "Pixel 8, 4");
  const json rows = browser_->evaluate(
      "[...document.querySelectorAll('.inspector .values > tr')].map(r => [...r.cells].map(c => "
      "c.textContent))");
  EXPECT_EQ(rows[0], json({"1", "reference: full", "0.2500", "0.2500", "0.2500", "0"}));
  EXPECT_EQ(rows[1], json({"2", "ramp", "0.3750", "0.3750", "0.3750", "0.1250"}));
  EXPECT_EQ(rows[2], json({"3", "<b>flat", "0.5000", "0.5000", "0.5000", "0.2500"}));
}

TEST_F(ReportViewer, ADragWithShiftGivesStatisticsOfTheRegion) {
  open_page();
  open_picture("scene-1", 1);
  const json from = place_of(2, 1);
  const json to = place_of(5, 4);
  browser_->drag(from[0], from[1], to[0], to[1], Held::shift);
  settle();
  EXPECT_EQ(state("region"), json({{"x", 2}, {"y", 1}, {"width", 4}, {"height", 4}}));
  ASSERT_TRUE(
      browser_->wait_for("document.querySelectorAll('.statistics > tr').length === 3 && "
                         "!document.querySelector('.statistics').textContent.includes('…')"));
  const json rows = browser_->evaluate(
      "[...document.querySelectorAll('.statistics > tr')].map(r => [...r.cells].map(c => "
      "c.textContent))");
  // ramp: x = 2 ... 5; r = 0.25.
  double squares = 0.0;
  for (int x = 2; x <= 5; ++x) squares += x * x / 4096.0 / 4.0;
  const std::string rmse =
      browser_->evaluate("formatNumber(" + std::to_string(std::sqrt(squares)) + ", 3)");
  const std::string relmse =
      browser_->evaluate("formatNumber(" + std::to_string(squares / 0.0725) + ", 3)");
  EXPECT_EQ(rows[1], json({"2", "ramp", "0.305", "0.281", "0.328", rmse, relmse}));
  EXPECT_EQ(rows[0], json({"1", "reference: full", "0.250", "0.250", "0.250", "0", "0"}));
  EXPECT_EQ(rows[2][1], "<b>flat1 not finite");
  keep_screenshot("region");
  press("x");
  EXPECT_EQ(state("region"), nullptr);
}

}  // namespace
