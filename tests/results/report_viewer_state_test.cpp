// The report's viewer in a real browser: links, sequences, and what it does where something is
// missing. Skipped where Chromium is not installed.
#include <string>

#include "results/html_report/html_text.h"
#include "results/html_report/page_frame.h"
#include "tests/results/report_viewer_fixture.h"
#include "tests/results/synthetic_run.h"

namespace {

using nlohmann::json;
using test_results::srgb_byte;
using tests::BrowserSession;
using tests::Held;

namespace fs = std::filesystem;

class ViewerState : public test_results::ReportViewer {};

TEST_F(ViewerState, ALinkRestoresTheWholeState) {
  open_page();
  open_picture("scene-1", 1);
  for (const char* key : {"v", "e", "e", "t", "n", "d", "w"}) press(key);
  press("3", Held::shift);
  const json at = place_of(12, 3);
  browser_->wheel(at[0], at[1], -200);
  browser_->drag(place_of(2, 1)[0], place_of(2, 1)[1], place_of(5, 4)[0], place_of(5, 4)[1],
                 Held::shift);
  settle();
  const std::string link = browser_->evaluate("linkOf(discernViewer.state)");
  ASSERT_TRUE(browser_->wait_for("location.hash.length > 40"));
  const std::string in_bar =
      browser_->evaluate("new Promise(done => setTimeout(() => done(location.hash), 500))");
  EXPECT_EQ(in_bar, link);
  browser_->open(page_, link);
  settle();
  EXPECT_EQ(browser_->evaluate("linkOf(discernViewer.state)"), link);
  EXPECT_EQ(state("views"), 2);
  EXPECT_EQ(state("exposure"), 1.0);
  EXPECT_EQ(state("filter"), "linear");
  EXPECT_EQ(state("other"), 2);
  EXPECT_EQ(state("panes[0].mode"), "signed");
}

TEST_F(ViewerState, ALinkThatNobodyMadeDoesNoHarm) {
  open_page({}, "#view=scene-1&images=99,-4&modes=nonsense|%&zoom=1e99&ev=x&region=1,2,a,9999");
  settle();
  EXPECT_EQ(browser_->evaluate("document.querySelector('.viewer').open"), false);  // a cut escape
  browser_->open(page_,
                 "#view=scene-1&images=99,-4&modes=nonsense&zoom=1e99&ev=x&region=8,8,99,99");
  settle();
  EXPECT_EQ(state("panes.slice(0, 2).map(p => p.image)"), json({2, 0}));
  EXPECT_EQ(state("zoom"), 256);
  EXPECT_EQ(state("region"), json({{"x", 8}, {"y", 8}, {"width", 8}, {"height", 4}}));
  browser_->open(page_, "#view=scene-77");
  EXPECT_EQ(browser_->evaluate("document.querySelector('.viewer').open"), false);
}

TEST_F(ViewerState, FramesOfASequenceHaveASliderAndPlay) {
  open_page();
  open_picture("scene-2", 1);
  EXPECT_EQ(state("scene.frames"), json({5, 6, 7}));
  expect_gray(4, 4, srgb_byte(0.125));
  press(".");
  expect_gray(4, 4, srgb_byte(0.25));
  press(",");
  press(",");
  EXPECT_EQ(state("frame"), 7);
  expect_gray(4, 4, srgb_byte(0.5));
  browser_->evaluate(
      "(() => { const s = document.querySelector('input[aria-label^=frame]'); "
      "s.value = 1; s.dispatchEvent(new Event('input')); })()");
  settle();
  expect_gray(4, 4, srgb_byte(0.25));
  press("k");
  EXPECT_TRUE(browser_->wait_for("discernViewer.state.frame === 5"));
  EXPECT_TRUE(browser_->wait_for("discernViewer.state.frame === 7"));
  press("k");
  EXPECT_EQ(browser_->evaluate("discernViewer.playTimer === undefined"), true);
}

TEST_F(ViewerState, ErrorMapsFollowTheFrames) {
  open_page();
  open_picture("scene-2-map-1", 1);
  EXPECT_EQ(state("panes[0].mode"), "relmse/full");
  expect_seen(4, 4, color_of("relmse/full", 0.0125));
  press(".");
  expect_seen(4, 4, color_of("relmse/full", 0.025));
  EXPECT_EQ(text_of(".viewer .head").find("the map is of frame"), std::string::npos);
  keep_screenshot("map-of-frame");
  // None was kept of the last frame: the first one's stays, and says so.
  press(".");
  expect_seen(4, 4, color_of("relmse/full", 0.0125));
  EXPECT_NE(text_of(".viewer .head").find("the map is of frame 5"), std::string::npos);
}

TEST_F(ViewerState, ImagesOfOtherSizesLieOnEachOtherAndHaveNoDifference) {
  open_page();
  open_picture("scene-3", 1);
  press("1", Held::shift);
  press("d");
  EXPECT_NE(text_of(".viewer .head").find("the sizes differ, 8 × 6 and 16 × 12"),
            std::string::npos);
  expect_gray(15, 11, srgb_byte(0.5));
  const json at = place_of(15, 11);
  browser_->move_to(at[0], at[1]);
  ASSERT_TRUE(
      browser_->wait_for("document.querySelectorAll('.inspector .values > tr').length === 2"));
  EXPECT_EQ(browser_->evaluate("placeIn({width: 8, height: 6}, {x: 15, y: 11}, "
                               "discernViewer.state.scene)"),
            json({{"x", 7}, {"y", 5}}));
}

TEST_F(ViewerState, PicturesWithoutFloatsFlipAndWipeToo) {
  std::string body;
  for (const float gray : {0.25F, 0.75F}) {
    perception::Image image = perception::make_rgb_image(4, 4, perception::Encoding::display);
    for (float& value : image.pixels) value = gray;
    body += "<img class=\"picture\" alt=\"<i>\" src=\"data:image/png;base64," +
            results::html_report::base64(perception::png_bytes(image)) + "\">";
  }
  page_ = results::html_report::write_page(folder_.path(),
                                           results::html_report::page_frame("plain", body));
  browser_ = std::make_unique<BrowserSession>(folder_.path() / "profile");
  browser_->open(page_);
  browser_->evaluate("document.querySelectorAll('img')[1].click()");
  settle();
  expect_gray(3, 1, 191);
  press("w");
  expect_gray(0, 1, 64);
  expect_gray(3, 1, 191);
  press("w");
  press("d");
  press("1");
  expect_gray(3, 1, 64);
  EXPECT_EQ(browser_->evaluate("location.hash"), "");
}

TEST_F(ViewerState, HelpOpensAndEscapeClosesItFirst) {
  open_page();
  open_picture("scene-1", 1);
  press("?");
  EXPECT_EQ(browser_->evaluate("document.querySelector('.help').hidden"), false);
  keep_screenshot("help");
  browser_->press("Escape");
  EXPECT_TRUE(browser_->wait_for("document.querySelector('.help').hidden"));
  EXPECT_EQ(browser_->evaluate("document.querySelector('.viewer').open"), true);
  browser_->press("Escape");
  EXPECT_TRUE(browser_->wait_for("!document.querySelector('.viewer').open"));
  EXPECT_EQ(browser_->evaluate("location.hash"), "");
}

TEST_F(ViewerState, WithoutWebGlACanvasShowsTheSameAndSaysSo) {
  BrowserSession::Options options;
  options.arguments = {"--disable-3d-apis"};
  open_page(options);
  open_picture("scene-1", 1);
  EXPECT_EQ(browser_->evaluate("discernViewer.painter.name"), "2D canvas");
  EXPECT_NE(text_of(".viewer .message").find("no WebGL2: drawn by a 2D canvas"), std::string::npos);
  expect_gray(8, 8, srgb_byte(0.375));
  press("d");
  expect_seen(8, 8, color_of("signed", 8.0 / 64.0), 3);
  for (int i = 0; i < 4; ++i) press("d");
  expect_seen(8, 8, color_of("relmse/full", 0.01), 3);
  press("3");
  press("D");
  expect_seen(3, 2, {0, 255, 255});
}

TEST_F(ViewerState, AfterTheContextIsLostACanvasGoesOn) {
  open_page();
  open_picture("scene-1", 1);
  browser_->evaluate("discernViewer.painter.gl.getExtension('WEBGL_lose_context').loseContext()");
  ASSERT_TRUE(browser_->wait_for("discernViewer.painter.name === '2D canvas'"));
  settle();
  expect_gray(8, 8, srgb_byte(0.375));
}

TEST_F(ViewerState, ASplitReportReadsItsFilesOnDemand) {
  open_page({}, "", {results::html_report::Split::always, 0});
  EXPECT_EQ(browser_->evaluate("floatCache.images.size"), 0);
  EXPECT_EQ(browser_->evaluate("document.querySelector('img.picture').naturalWidth"), 16);
  open_picture("scene-1", 1);
  expect_gray(8, 8, srgb_byte(0.375));
  fs::remove_all(page_.parent_path() / "data");
  press("d");  // the inspector may have read them all already; the second scene was not
  browser_->press("Escape");
  browser_->evaluate("viewer.open({scene: sceneByKey('scene-2'), image: 0, mode: 'image'})");
  settle();
  EXPECT_NE(text_of(".viewer .head").find(".js cannot be read"), std::string::npos);
  // The browser tells the console of the missing file; that is what this test provokes.
  ASSERT_GE(browser_->console().size(), 1U);
  for (const std::string& line : browser_->console()) {
    EXPECT_NE(line.find("ERR_FILE_NOT_FOUND"), std::string::npos) << line;
  }
  browser_.reset();
}

TEST_F(ViewerState, TheOverviewIsFilteredByWordsAndStates) {
  const fs::path run = test_results::write_synthetic_run(folder_.path(), 32, 24);
  page_ = results::html_report::write_report(results::load_run(run)).index;
  browser_ = std::make_unique<BrowserSession>(folder_.path() / "profile");
  browser_->open(page_);
  const auto shown = [&] {
    return browser_->evaluate(
        "[...document.querySelectorAll('#matrix [data-state]')].filter(c => "
        "!c.classList.contains('dimmed') && c.getClientRects().length > 0).length");
  };
  const auto type = [&](const std::string& text) {
    browser_->evaluate(
        "(() => { const f = document.querySelector('#matrix-filter input'); f.focus(); "
        "f.select(); })()");
    for (const char letter : text) browser_->press(std::string(1, letter));
  };
  EXPECT_EQ(shown(), 8);  // two scenes, four methods
  type("pt8");
  EXPECT_EQ(shown(), 2);
  EXPECT_EQ(text_of("#matrix-filter output"), "2 of 8");
  EXPECT_EQ(browser_->evaluate("[...document.querySelectorAll('#numbers tbody tr')].filter(r => "
                               "r.getClientRects().length > 0).length"),
            2);
  type("box broken");
  EXPECT_EQ(shown(), 1);
  keep_screenshot("filter");
  type("nothing of the kind");
  EXPECT_EQ(shown(), 0);
  browser_->evaluate(
      "(() => { const f = document.querySelector('#matrix-filter input'); f.value = "
      "''; f.dispatchEvent(new Event('input')); "
      "document.querySelector('#matrix-filter input[value=ok]').click(); "
      "document.querySelector('#matrix-filter input[value=open]').click(); })()");
  EXPECT_EQ(shown(), 1);  // one method crashed in one scene
}

TEST_F(ViewerState, ARealisticReportIsShown) {
  const fs::path run = test_results::write_synthetic_run(folder_.path(), 320, 240);
  page_ = results::html_report::write_report(results::load_run(run)).index;
  BrowserSession::Options options;
  options.height_px = 1000;
  options.is_dark = true;
  browser_ = std::make_unique<BrowserSession>(folder_.path() / "profile", options);
  browser_->open(page_);
  keep_screenshot("page-dark");
  open_picture("scene-1", 3);
  keep_screenshot("viewer");
  press("v");
  press("v");
  press("p");
  for (int i = 0; i < 3; ++i) press("d");
  keep_screenshot("viewer-four");
  EXPECT_EQ(state("panes[1].mode"), "relative");
}

}  // namespace
