#include "results/html_report/html_report.h"

#include <regex>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "perception/base/atomic_file.h"
#include "perception/image_file.h"
#include "results/html_report/html_text.h"
#include "results/html_report/picture.h"
#include "results/html_report/stage_bars.h"
#include "tests/results/synthetic_run.h"
#include "tests/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using results::html_report::html_report;
using tests::TemporaryFolder;

std::size_t count(const std::string& text, const std::string& wanted) {
  std::size_t found = 0;
  for (std::size_t at = text.find(wanted); at != std::string::npos;
       at = text.find(wanted, at + wanted.size())) {
    ++found;
  }
  return found;
}

bool has(const std::string& text, const std::string& wanted) { return count(text, wanted) > 0; }

/// The page of one synthetic run, made once.
class HtmlReport : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder();
    run_folder_ = test_results::write_synthetic_run(folder_->path(), 64, 48);
    page_ = new std::string(html_report(results::load_run(run_folder_)));
  }
  static void TearDownTestSuite() {
    delete page_;
    delete folder_;
  }
  static const std::string& page() { return *page_; }

  static TemporaryFolder* folder_;
  static fs::path run_folder_;
  static std::string* page_;
};
TemporaryFolder* HtmlReport::folder_ = nullptr;
fs::path HtmlReport::run_folder_;
std::string* HtmlReport::page_ = nullptr;

TEST_F(HtmlReport, EverySectionIsThereOnce) {
  for (const char* id : {"overview", "scene-1", "scene-2", "failures", "provenance"}) {
    EXPECT_EQ(count(page(), "<section id=\"" + std::string(id) + "\""), 1U) << id;
    EXPECT_EQ(count(page(), "<a href=\"#" + std::string(id) + "\">") > 0, true) << id;
  }
}

TEST_F(HtmlReport, SameResultsGiveTheSameBytes) {
  EXPECT_EQ(html_report(results::load_run(run_folder_)), page());
}

TEST_F(HtmlReport, LoadsNothingFromOutside) {
  const std::regex outside(R"re((src|href)\s*=\s*["'](?!#|data:))re");
  EXPECT_FALSE(std::regex_search(page().substr(0, 60000), outside));
  for (const char* forbidden : {"http://", "https://", "fetch(", "XMLHttpRequest", "import("}) {
    EXPECT_FALSE(has(page(), forbidden)) << forbidden;
  }
}

TEST_F(HtmlReport, WhatAUserNamesIsEscaped) {
  EXPECT_FALSE(has(page(), "<script>alert"));
  EXPECT_TRUE(has(page(), "&lt;script&gt;alert(1)&lt;/script&gt;"));
  EXPECT_FALSE(has(page(), "<i>"));
  EXPECT_FALSE(has(page(), "<gather>"));
  EXPECT_FALSE(has(page(), "<b>\""));
  EXPECT_EQ(count(page(), "<script>"), 1U);  // its own
}

TEST_F(HtmlReport, HeaderSaysWhatWasRunWhereAndHowItWent) {
  EXPECT_TRUE(has(page(), "<h1>quick</h1>"));
  EXPECT_TRUE(has(page(), "20261122T001209Z-0a1b2c"));
  EXPECT_TRUE(has(page(), "2026-11-22T00:12:09Z"));
  EXPECT_TRUE(has(page(), "<dd>running, as of 2026-11-22T00:13:00Z</dd>"));
  EXPECT_TRUE(has(page(), "<dd>smoke</dd>"));
  EXPECT_TRUE(has(page(), "200 cd/m² peak"));
  EXPECT_TRUE(has(page(),
                  "<b class=\"ok\">6 ok</b> <b class=\"failed\">1 failed</b> "
                  "<b class=\"skipped\">1 not run</b> <b class=\"skipped\">2 not yet</b>"));
}

TEST_F(HtmlReport, TimesAndScoresAreTheStoredOnes) {
  // Median of 1.21, 1.22, 1.26, 1.27.
  EXPECT_TRUE(has(page(), "<div class=\"time\">1.24 s ±"));
  EXPECT_TRUE(has(page(), "<div class=\"time\">400 ms</div>"));
  // flip of pt8: mean of 0.011 and 0.012, t interval with one degree of freedom.
  EXPECT_TRUE(has(page(), "~0.0115 ±0.0064"));
  EXPECT_TRUE(has(page(), "<small>floor 0.020</small>"));
}

TEST_F(HtmlReport, RanksFollowTheMetricsDirection) {
  // Against all light pt8 is better in both: a lower flip, a higher psnr.
  EXPECT_TRUE(has(page(), "<td class=\"rank-0\" title=\"0.0115 ±0.0064\">~0.0115</td>"));
  EXPECT_TRUE(has(page(), "<td class=\"rank-4\" title=\"0.220\">0.220</td>"));
  EXPECT_TRUE(has(page(), "<td class=\"rank-4\" title=\"6.58\">6.58</td>"));
}

TEST_F(HtmlReport, EveryPictureIsEmbeddedAtFullSize) {
  // Per scene: two references (full and direct), two methods.
  EXPECT_EQ(count(page(), "width=\"64\" height=\"48\" data-group=\"scene-1\""), 4U);
  EXPECT_TRUE(has(page(), "alt=\"reference: full\""));
  EXPECT_TRUE(has(page(), "alt=\"reference: direct\""));
  EXPECT_TRUE(has(page(), "<figcaption><b>pt8</b><span>1.21 s · 64 samples · seed 1</span>"));
}

TEST_F(HtmlReport, ExposureIsTheScenesOwn) {
  EXPECT_TRUE(has(page(), "exposure 0 EV"));
  EXPECT_TRUE(has(page(), "exposure 1.00 EV"));
}

TEST_F(HtmlReport, MapsShareOneScalePerMetricAndAreEmbeddedOnce) {
  // Three metrics x two scenes.
  EXPECT_EQ(count(page(), "<svg class=\"color-bar\""), 6U);
  // pt8 claims full transport, so its maps against `own` are those against `full`.
  EXPECT_EQ(count(page(), "alt=\"pt8 · own = full\">"), 6U);
  EXPECT_EQ(count(page(), "<figcaption><b>direct-only</b><span>full: "), 6U);
  EXPECT_EQ(count(page(), "<figcaption><b>direct-only</b><span>own: "), 6U);
  EXPECT_EQ(count(page(), "data-group=\"scene-1-map-1\""), 3U);
}

TEST_F(HtmlReport, StagesShowPrepareRenderAndTheRest) {
  EXPECT_TRUE(has(page(), "class=\"stage-build prepare\" style=\"width:20.000%\""));
  EXPECT_TRUE(has(page(), "class=\"stage-transport\" style=\"width:50.000%\""));
  EXPECT_TRUE(has(page(), "class=\"stage-unattributed\" style=\"width:10.000%\""));
  EXPECT_TRUE(has(page(), "hatched: prepare; plain: render"));
  EXPECT_TRUE(has(page(), "not in total</td>"));
  EXPECT_FALSE(has(page(), "class=\"stage-readback\" style"));
}

TEST_F(HtmlReport, FailuresShowStatusReasonAndTheEndOfTheLog) {
  EXPECT_TRUE(has(page(), "signal 11 (Segmentation fault) in &lt;gather&gt;"));
  EXPECT_TRUE(has(page(), "log line 60 &lt;&amp;&gt;"));
  EXPECT_TRUE(has(page(), "log line 21 "));
  EXPECT_FALSE(has(page(), "log line 20 "));
  EXPECT_TRUE(has(page(), "the scene has: environment"));
  EXPECT_TRUE(has(page(), "no reference</span> attic · one_bounce</h4>\n<p>out of &lt;memory&gt;"));
}

TEST_F(HtmlReport, ProvenanceHasMachineCommandSuiteAndReferences) {
  EXPECT_TRUE(has(page(), "discern run quick --filter &quot;&lt;b&gt;&quot;"));
  EXPECT_TRUE(has(page(), "scenes: [{id: box}]"));
  EXPECT_TRUE(has(page(), "samples 4096, seed 1000003"));
  EXPECT_TRUE(has(page(), "<td>compiler</td>"));
  EXPECT_TRUE(has(page(), "OpenEXR 3."));
  EXPECT_TRUE(has(page(), "max_depth 8, clamp 0.5, nee true, bounces all"));
}

TEST_F(HtmlReport, IsWrittenBesideTheRun) {
  const fs::path path = results::html_report::write_report(results::load_run(run_folder_)).index;
  EXPECT_EQ(path, run_folder_ / "report" / "index.html");
  EXPECT_EQ(base::read_text_file(path), page());
}

TEST(HtmlReportOfAPartialRun, WorksBeforeAnythingHasEnded) {
  const TemporaryFolder folder;
  results::RunFolder run = results::RunFolder::open_for_writing(folder.path() / "runs/s/r");
  run.write_run_json({{"schema", 1}});
  const std::string page = html_report(results::load_run(run.path()));
  EXPECT_TRUE(has(page, "no cell has ended yet"));
  EXPECT_TRUE(has(page, "<h1>s</h1>"));
}

TEST(HtmlReportOfAPartialRun, TheReferenceIsShownAsSoonAsItIsMade) {
  const TemporaryFolder folder;
  const fs::path written = test_results::write_synthetic_run(folder.path(), 16, 16);
  fs::remove(written / "metrics.jsonl");
  const std::string page = html_report(results::load_run(written));
  EXPECT_EQ(count(page, "alt=\"reference: full\""), 1U);  // run.json names that of "box" only
  EXPECT_FALSE(has(page, "<h3>Error maps</h3>"));
  EXPECT_TRUE(has(page, "<td class=\"n\">not yet</td>"));
}

TEST(HtmlReportOfAPartialRun, BudgetsAreNamedWhereAMethodHasSeveral) {
  const TemporaryFolder folder;
  results::RunFolder run = results::RunFolder::open_for_writing(folder.path() / "runs/s/r");
  results::CellRecord cell = test_results::timed_cell("box", "swept", 1, 1.0);
  run.append(cell);
  cell.budget = "8spp";
  cell.cell += "8";
  run.append(cell);
  run.append(test_results::timed_cell("box", "plain", 1, 1.0));
  const std::string page = html_report(results::load_run(run.path()));
  EXPECT_TRUE(has(page, "<b>swept · 64spp</b>"));
  EXPECT_TRUE(has(page, "<b>swept · 8spp</b>"));
  EXPECT_TRUE(has(page, "<b>plain</b>"));
}

TEST(HtmlReportOfAPartialRun, MissingAndUnreadableImagesSaySo) {
  const TemporaryFolder folder;
  results::RunFolder run = results::RunFolder::open_for_writing(folder.path() / "runs/s/r");
  results::CellRecord cell = test_results::timed_cell("box", "gone", 1, 1.0);
  cell.render.image = "images/gone.exr";
  run.append(cell);
  cell = test_results::timed_cell("box", "cut", 1, 1.0);
  cell.render.image = "images/cut.exr";
  run.append(cell);
  fs::create_directories(run.path() / "images");
  base::write_text_file(run.path() / "images/cut.exr", "not an image");
  const std::string page = html_report(results::load_run(run.path()));
  EXPECT_TRUE(has(page, "<div class=\"no-picture\">not yet</div>"));
  const std::regex unreadable("<div class=\"no-picture\">[^<]*images/cut.exr: [^<]+</div>");
  EXPECT_TRUE(std::regex_search(page, unreadable));
  EXPECT_FALSE(has(page, "data:image"));
}

TEST(HtmlReportOfASearch, TellsTargetFoundSettingAndEveryRender) {
  const TemporaryFolder folder;
  results::RunFolder run = results::RunFolder::open_for_writing(folder.path() / "runs/s/r");
  run.append(test_results::timed_cell("box", "pt", 1, 1.0));
  results::SearchRecord search{"box", "pt", "1s",  "samples", "total_s", 1.0,
                               52.0,  0.98, "met", "",        {}};
  search.probes = {{16.0, 0.31}, {52.0, 0.98}};
  run.append(search);
  search.budget = "relmse=1e-09";
  search.value.reset();
  search.outcome = "below_noise_floor";
  search.reason = "less than <noise>";
  run.append(search);
  const std::string page = html_report(results::load_run(run.path()));
  EXPECT_TRUE(has(page, "<a href=\"#searches\">"));
  EXPECT_TRUE(has(page, "16: 0.310, 52: 0.980"));
  EXPECT_TRUE(has(page, "below noise floor: less than &lt;noise&gt;"));
}

TEST(HtmlReportOfCounters, HasAColumnPerCounterAndTheRangeOfASeries) {
  const TemporaryFolder folder;
  results::RunFolder run = results::RunFolder::open_for_writing(folder.path() / "runs/s/r");
  results::CellRecord cell = test_results::timed_cell("box", "val", 1, 1.0);
  cell.render.counters = {{"vals", 30.0}, {"links", std::vector<double>{4.0, 2.0, 9.0}}};
  run.append(cell);
  const std::string page = html_report(results::load_run(run.path()));
  EXPECT_TRUE(has(page, "<summary>Counters</summary>"));
  EXPECT_TRUE(has(page, ">vals<"));
  EXPECT_TRUE(has(page, "2 to 9 in 3 values"));
}

TEST(HtmlText, EscapesWhatHtmlReads) {
  EXPECT_EQ(results::escape(R"(<a href="x">'&'</a>)"),
            "&lt;a href=&quot;x&quot;&gt;&#39;&amp;&#39;&lt;/a&gt;");
  EXPECT_EQ(results::escape("<\u202egpj\u00e9"), "&lt;\\u202egpj\u00e9");
}

TEST(HtmlText, Base64OfTheStandardsTestVectors) {  // RFC 4648, Sec. 10
  using results::html_report::base64;
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

TEST(Picture, ReducingKeepsTheMean) {
  perception::Image image =
      perception::make_gray_image(8, 4, "Y", perception::Encoding::scene_linear);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(i);
  const perception::Image small = results::html_report::reduced(image, 4);
  ASSERT_EQ(small.width_px, 4);
  ASSERT_EQ(small.height_px, 2);
  EXPECT_FLOAT_EQ(small.at(0, 0), (0 + 1 + 8 + 9) / 4.0F);
  EXPECT_FLOAT_EQ(small.at(3, 1), (22 + 23 + 30 + 31) / 4.0F);
}

TEST(Picture, WideRenderingsGetASmallerThumbnail) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "wide.exr";
  perception::write_exr(
      path,
      {{{"radiance", perception::make_rgb_image(480, 16, perception::Encoding::scene_linear)}},
       {}});
  const auto picture = results::html_report::rendering_picture(path, "", 0.0);
  EXPECT_EQ(picture.width_px, 480);
  EXPECT_NE(picture.thumbnail, picture.uri);
  EXPECT_EQ(picture.uri.rfind("data:image/png;base64,iVBORw0KGgo", 0), 0U);
  EXPECT_EQ(results::html_report::rendering_picture(path, "indirect", 0.0).missing,
            path.string() + ": has no part \"indirect\"");
}

TEST(StageBars, SpansAddUpToTheTotal) {
  const auto cell = test_results::timed_cell("box", "a", 1, 2.0);
  double sum_s = 0.0;
  for (const auto& span : results::html_report::stage_spans(cell.render)) sum_s += span.wall_s;
  EXPECT_NEAR(sum_s, 2.0, 1e-12);
}

TEST(StageBars, NestedReadbackIsTakenOutOfTheStagesAroundIt) {
  auto render = test_results::timed_cell("box", "a", 1, 2.0).render;
  // Another readback inside `transport/sum`, with a part and a readback of its own; `transport` is
  // longer by what is not in the total.
  auto& stages = render.stages;
  ASSERT_EQ(stages[3].path, "transport");
  stages[3].wall_s += 0.4;
  for (const auto& [path, wall_s] :
       std::vector<std::pair<std::string, double>>{{"transport/sum", 0.5},
                                                   {"transport/sum/readback", 0.4},
                                                   {"transport/sum/readback/copy", 0.3},
                                                   {"transport/sum/readback/readback", 0.1}}) {
    stages.push_back(stages[3]);
    stages.back().path = path;
    stages.back().wall_s = wall_s;
  }
  double sum_s = 0.0;
  for (const auto& span : results::html_report::stage_spans(render)) sum_s += span.wall_s;
  EXPECT_NEAR(sum_s, 2.0, 1e-12);
  const auto shown = results::html_report::stages_of_total(render);
  ASSERT_EQ(shown.size(), stages.size());
  EXPECT_NEAR(shown[3].wall_s, 1.0, 1e-12);  // transport
  EXPECT_NEAR(shown[6].wall_s, 0.1, 1e-12);  // transport/sum
  EXPECT_EQ(shown[7].wall_s, 0.4);           // its readback stays as it is
  EXPECT_FALSE(results::html_report::is_readback(shown[6]));
  for (const std::size_t i : {5U, 7U, 8U, 9U}) {
    EXPECT_TRUE(results::html_report::is_readback(shown[i])) << shown[i].path;
  }
}

TEST(StageBars, NestedReadbackHasNoShareOfTheTotal) {
  const TemporaryFolder folder;
  results::RunFolder run = results::RunFolder::open_for_writing(folder.path() / "runs/s/r");
  results::CellRecord cell = test_results::timed_cell("box", "a", 1, 1.0);
  cell.render.start_up_s = 0.0;  // not in the total either
  cell.render.stages.back().path = "gather/readback";
  cell.render.stages[4].wall_s += cell.render.stages.back().wall_s;
  run.append(cell);
  const std::string page = html_report(results::load_run(run.path()));
  EXPECT_EQ(count(page, "not in total</td>"), 1U);
  EXPECT_TRUE(has(page, "class=\"stage-gather\" style=\"width:15.000%\""));
}

TEST(HtmlReportOfSeeds, AScoreThatLacksSeedsSaysSoAndHasNoRank) {
  const TemporaryFolder folder;
  results::RunFolder run = results::RunFolder::open_for_writing(folder.path() / "runs/s/r");
  for (const char* method : {"a", "b", "c"}) {
    for (const std::uint64_t seed : {1U, 2U}) {
      const auto cell = test_results::timed_cell("box", method, seed, 1.0);
      run.append(cell);
      results::MetricRecord score = test_results::full_metric_record();
      score.cell = cell.cell;
      score.metric = "psnr";
      score.value = *method == 'a' ? 19.0 + static_cast<double>(seed) : 30.0;
      if (*method == 'c' || (*method == 'b' && seed == 2)) score.value.reset();
      score.is_infinite = *method == 'c';
      score.noise_floor.reset();
      run.append(score);
    }
  }
  const std::string page = html_report(results::load_run(run.path()));
  EXPECT_TRUE(has(page, "<td title=\"30.0 (1 of 2 seeds)\">30.0<small>1 of 2 seeds</small></td>"));
  EXPECT_TRUE(has(page, "<td class=\"rank-4\" title=\"20.5 ±6.4\">20.5</td>"));
  EXPECT_TRUE(has(page, "<td class=\"rank-0\" title=\"∞\">∞</td>"));
  EXPECT_EQ(count(page, "data-sort=\"Infinity\">∞"), 2U);  // the scene's scores, all numbers
}

TEST(StageBars, TicksAreRoundNumbersFromZeroToTheEnd) {
  using results::html_report::axis_ticks;
  const std::vector<double> ticks = axis_ticks(1.0);
  ASSERT_EQ(ticks.size(), 6U);
  EXPECT_NEAR(ticks.back(), 1.0, 1e-12);
  EXPECT_EQ(axis_ticks(0.0037).size(), 4U);  // 0, 1, 2, 3 ms
}

TEST(StageBars, UnknownStagesHaveAColourToo) {
  EXPECT_EQ(results::html_report::stage_class("transport"), "stage-transport");
  EXPECT_EQ(results::html_report::stage_class("\"><script>"), "stage-other");
}

}  // namespace
