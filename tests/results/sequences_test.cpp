// Runs of sequences: what becomes of their frames in summaries, tables and reports.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "perception/image_file.h"
#include "results/html_report/frame_chart.h"
#include "results/html_report/html_report.h"
#include "results/html_report/stage_bars.h"
#include "results/tables.h"
#include "tests/results/synthetic_run.h"
#include "tests/temporary_folder.h"

namespace {

using renderers::Phase;
using results::CellRecord;
using results::FrameTimes;
using results::MetricRecord;
using results::RunSummary;
using results::ScoreSummary;
using results::Status;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A frame of a sequence's repetition; the first one is a cold start.
CellRecord frame_cell(std::uint64_t seed, int repetition, int frame, double seconds) {
  CellRecord cell = test_results::timed_cell("box", "a", seed, seconds);
  cell.repetition = repetition;
  results::RenderRecord& render = cell.render;
  render.frame = frame;
  render.image = "images/" + cell.cell + "/frame-000" + std::to_string(frame) + ".exr";
  if (frame == 0) return cell;
  render.total_s = kNan;
  render.prepare_s = kNan;
  render.next_frame_s = seconds;
  render.update_s = 0.4 * seconds;
  for (renderers::StageRecord& stage : render.stages) {
    if (stage.phase == Phase::prepare) stage.phase = Phase::update;
  }
  return cell;
}

MetricRecord frame_score(const CellRecord& cell, const std::string& metric, double value) {
  MetricRecord score = test_results::full_metric_record();
  score.cell = cell.cell;
  score.frame = cell.render.frame;
  score.metric = metric;
  score.value = value;
  score.noise_floor.reset();
  score.map.clear();
  return score;
}

results::Run run_of(std::vector<CellRecord> cells) {
  results::Run run;
  run.info = std::make_shared<nlohmann::ordered_json>(nlohmann::ordered_json::object());
  run.cells = std::move(cells);
  return run;
}

FrameTimes times_of(const std::vector<CellRecord>& cells) {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < cells.size(); ++i) all.push_back(i);
  return results::frame_times(cells, all);
}

TEST(FrameTimesOf, QuantilesAreOverFramesThenOverRepetitions) {
  std::vector<CellRecord> cells;
  for (int repetition = 0; repetition < 3; ++repetition) {
    // A slow cold start, then 1 ... 5 s, ten times that in the last repetition.
    cells.push_back(frame_cell(1, repetition, 0, 1000.0));
    for (int frame = 1; frame <= 5; ++frame) {
      cells.push_back(frame_cell(1, repetition, frame, (repetition == 2 ? 10.0 : 1.0) * frame));
    }
  }
  const FrameTimes times = times_of(cells);
  EXPECT_EQ(times.p50_s->value, 3.0);
  EXPECT_EQ(times.p50_s->high, 30.0);
  EXPECT_EQ(times.p50_s->count, 3U);
  EXPECT_DOUBLE_EQ(times.p95_s->value, 4.8);  // type 7: 1 + 0.95 x 4
  ASSERT_EQ(times.frames.size(), 5U);
  EXPECT_EQ(times.frames[1].frame, 2);
  EXPECT_EQ(times.frames[1].next_frame_s.value, 2.0);
  EXPECT_EQ(times.frames[1].next_frame_s.high, 20.0);
  EXPECT_EQ(cells[times.typical.value()].render.next_frame_s, 4.0);  // of 1 1 2 2 3 3 4 4 5 5 10 ..
}

TEST(FrameTimesOf, FailedFramesAndStillScenesHaveNone) {
  std::vector<CellRecord> cells{frame_cell(1, 0, 0, 1.0), frame_cell(1, 0, 1, 2.0)};
  cells[1].render.status = Status::crash;
  EXPECT_FALSE(times_of(cells).p50_s.has_value());
  EXPECT_TRUE(times_of(cells).frames.empty());
  EXPECT_FALSE(times_of({test_results::timed_cell("box", "a", 1, 1.0)}).typical.has_value());
}

TEST(SequenceSummary, TheTotalIsThatOfFirstFramesAndRepetitionsAreCountedOnce) {
  std::vector<CellRecord> cells;
  for (int repetition = 0; repetition < 2; ++repetition) {
    for (int frame = 0; frame < 3; ++frame) {
      cells.push_back(frame_cell(1, repetition, frame, 1.0 + frame + 0.5 * repetition));
    }
  }
  cells.back().render.status = Status::timeout;
  const RunSummary summary = summarize(run_of(cells));
  ASSERT_EQ(summary.rows.size(), 1U);
  const results::SummaryRow& row = summary.rows[0];
  EXPECT_EQ(row.total_s->value, 1.25);
  EXPECT_EQ(row.total_s->count, 2U);
  EXPECT_EQ(row.repetitions, 2U);
  EXPECT_EQ(row.records.size(), 6U);
  EXPECT_EQ(format_statuses(row), "1 ok, 1 timeout");
  EXPECT_EQ(row.shown, 0U);
  EXPECT_EQ(row.typical, 0U);
  EXPECT_EQ(summary.failed_cells, 1U);
}

TEST(SequenceSummary, ScoresAreTheMedianOverFramesWithTheWorstOne) {
  const std::vector<CellRecord> cells{frame_cell(1, 0, 0, 1.0), frame_cell(1, 0, 1, 1.0),
                                      frame_cell(1, 0, 2, 1.0), frame_cell(2, 0, 0, 1.0),
                                      frame_cell(2, 0, 1, 1.0), frame_cell(2, 0, 2, 1.0)};
  auto run = run_of(cells);
  const std::vector<double> flip{0.1, 0.5, 0.2, 0.3, 0.4, 0.2};
  const std::vector<double> ssim{0.9, 0.5, 0.8, 0.7, 0.8, 0.2};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    run.metrics.push_back(frame_score(cells[i], "flip", flip[i]));
    run.metrics.push_back(frame_score(cells[i], "ssim", ssim[i]));
  }
  const RunSummary summary = summarize(run);
  const ScoreSummary& errors = *summary.rows[0].find_score("flip", "full");
  EXPECT_DOUBLE_EQ(errors.score->value, 0.25);  // of 0.2 and 0.3
  ASSERT_EQ(errors.frames.size(), 3U);
  EXPECT_DOUBLE_EQ(errors.frames[1].value, 0.45);
  EXPECT_EQ(errors.worst->frame, 1);
  EXPECT_DOUBLE_EQ(errors.worst->value, 0.45);
  // Where higher is better the worst one is the lowest.
  EXPECT_EQ(summary.rows[0].find_score("ssim", "full")->worst->frame, 2);
  EXPECT_EQ(results::format_worst_frame(errors), "worst 0.450 at 1");
  EXPECT_TRUE(summary.rows[0].find_score("flip", "own")->frames.empty());
}

TEST(SequenceSummary, AFrameWithoutANumberIsNoWorstFrame) {
  const std::vector<CellRecord> cells{frame_cell(1, 0, 0, 1.0), frame_cell(1, 0, 1, 1.0)};
  auto run = run_of(cells);
  run.metrics = {frame_score(cells[0], "flip", 0.2), frame_score(cells[1], "flip", 0.0)};
  run.metrics[1].value.reset();
  const RunSummary summary = summarize(run);
  const ScoreSummary& score = *summary.rows[0].find_score("flip", "full");
  EXPECT_FALSE(score.score.has_value());
  EXPECT_EQ(score.non_finite, 1U);
  EXPECT_EQ(score.worst->frame, 0);
  ASSERT_EQ(score.frames.size(), 2U);
  EXPECT_TRUE(std::isnan(score.frames[1].value));
}

TEST(SequenceSummary, ScoresOfSequenceMetricsAreTheMeanOverFrames) {
  const std::vector<CellRecord> cells{frame_cell(1, 0, 0, 1.0), frame_cell(1, 0, 1, 1.0),
                                      frame_cell(1, 0, 2, 1.0), frame_cell(1, 0, 3, 1.0)};
  auto run = run_of(cells);
  const std::vector<double> values{9.0, 1.0, 2.0, 6.0};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    run.metrics.push_back(frame_score(cells[i], "flip", values[i]));
    if (i > 0) run.metrics.push_back(frame_score(cells[i], "flicker,tvi_scale=2", values[i]));
  }
  const RunSummary summary = summarize(run);
  const ScoreSummary& flicker = *summary.rows[0].find_score("flicker,tvi_scale=2", "full");
  EXPECT_DOUBLE_EQ(flicker.score->value, 3.0);
  EXPECT_EQ(flicker.worst->frame, 3);
  ASSERT_EQ(flicker.frames.size(), 3U);
  EXPECT_EQ(flicker.frames[0].frame, 1);
  // Of the other metrics it is the median.
  EXPECT_DOUBLE_EQ(summary.rows[0].find_score("flip", "full")->score->value, 4.0);
  EXPECT_TRUE(results::is_sequence_metric("flicker,tvi_scale=2"));
  EXPECT_FALSE(results::is_sequence_metric("flip"));
  EXPECT_FALSE(results::is_sequence_metric("unheard-of"));
  EXPECT_TRUE(results::is_sequence_metric("edges:flicker,tvi_scale=2"));
  EXPECT_EQ(results::metric_id_of("edges:flicker,tvi_scale=2"), "edges");
  EXPECT_EQ(results::metric_id_of("flicker,csf=a:b"), "");
}

TEST(SequenceTables, SayWhyASequenceMetricHasNoScore) {
  std::vector<CellRecord> cells{frame_cell(1, 0, 0, 1.0), frame_cell(1, 0, 1, 0.25),
                                frame_cell(1, 0, 2, 0.25)};
  cells.push_back(test_results::timed_cell("still", "a", 1, 2.0));
  CellRecord broken = frame_cell(1, 0, 0, 1.0);
  broken.method = "b";
  broken.cell = "box.b.64spp.s1-01234567";
  cells.push_back(broken);
  broken.render.frame = 1;
  broken.render.status = Status::crash;
  broken.render.image.clear();
  cells.push_back(broken);
  auto run = run_of(cells);
  run.info = std::make_shared<nlohmann::ordered_json>(nlohmann::ordered_json{
      {"scenes", {{{"id", "box"}, {"frames", {0, 1, 2}}}, {{"id", "still"}, {"frames", nullptr}}}},
      {"metrics", {"flicker"}}});
  run.metrics = {frame_score(cells[1], "flicker", 0.5), frame_score(cells[2], "flicker", 1.5)};
  const RunSummary summary = summarize(run);
  const auto text_of = [&](std::size_t row) {
    const ScoreSummary& score = *summary.rows[row].find_score("flicker", "full");
    return format_score(summary.rows[row], score) + "|" +
           format_score_note(summary.rows[row], score);
  };
  ASSERT_EQ(summary.rows.size(), 3U);
  EXPECT_EQ(text_of(0), "1.00|worst 1.50 at 2");
  EXPECT_EQ(text_of(1), "-|");  // its sequence broke before the second frame
  EXPECT_EQ(text_of(2), "n/a|not a sequence");
  const std::string table = to_text(summary_table(summary));
  EXPECT_NE(table.find("flicker (full) ↓"), std::string::npos) << table;
  EXPECT_NE(table.find("n/a, not a sequence"), std::string::npos) << table;
  EXPECT_NE(
      table.find("of a sequence a score is the median over the frames; of flicker, the change "
                 "from frame to frame, the mean\n"),
      std::string::npos)
      << table;
}

TEST(SequenceTables, HaveTheColumnsThatAreMeasured) {
  std::vector<CellRecord> cells{frame_cell(1, 0, 0, 1.0), frame_cell(1, 0, 1, 0.25),
                                frame_cell(1, 0, 2, 0.75)};
  cells[0].render.new_view_s = 0.5;
  cells.push_back(test_results::timed_cell("still", "a", 1, 2.0));
  auto run = run_of(cells);
  run.metrics = {frame_score(cells[0], "flip", 0.1), frame_score(cells[1], "flip", 0.3),
                 frame_score(cells[2], "flip", 0.2), frame_score(cells[3], "flip", 0.4)};
  const std::string text = to_text(summary_table(summarize(run)));
  EXPECT_EQ(text,
            "scene  method  budget  reps  total ↓  new view ↓  next frame ↓  next frame ↓  flip "
            "(own) ↓            flip (full) ↓  status\n"
            "                              median      median           p50           p95\n"
            "box    a       64spp      1   1.00 s      500 ms        500 ms        725 ms       "
            "not yet  0.200, worst 0.300 at 1  ok\n"
            "still  a       64spp      1   2.00 s           -             -             -       "
            "not yet                    0.400  ok\n"
            "↓ lower is better, ↑ higher is better; ± is the 95 % interval\n"
            "(own) against the transport the method claims, (full) against all light\n"
            "new view: the same scene once more, the camera turned a little\n"
            "next frame: update + render, what half (p50) and 95 % (p95) of the frames stay below; "
            "total is the first frame\n"
            "of a sequence a score is the median over the frames\n");
}

TEST(SequenceStore, ARepetitionMadeAgainReplacesItsFrames) {
  const tests::TemporaryFolder folder;
  {
    auto run = results::RunFolder::open_for_writing(folder.path() / "run");
    run.append(frame_cell(1, 0, 0, 1.0));
    run.append(frame_cell(1, 0, 1, 2.0));
    run.append(frame_cell(1, 0, 0, 3.0));  // the run was interrupted and goes on
    run.append(frame_cell(1, 0, 1, 4.0));
    run.append(frame_cell(1, 1, 0, 5.0));
  }
  const results::Run run = results::load_run(folder.path() / "run");
  ASSERT_EQ(run.cells.size(), 3U);
  EXPECT_EQ(run.cells[0].render.total_s, 3.0);
  EXPECT_EQ(run.cells[1].render.next_frame_s, 4.0);
  EXPECT_EQ(run.cells[2].repetition, 1);
}

TEST(SequenceStages, OfAFollowingFrameAreUpdateAndRender) {
  const auto spans = results::html_report::stage_spans(frame_cell(1, 0, 1, 1.0).render);
  ASSERT_EQ(spans.size(), 5U);
  EXPECT_EQ(spans[0].phase, "update");
  EXPECT_EQ(spans[0].name, "build");
  EXPECT_EQ(spans[2].phase, "render");
  EXPECT_EQ(spans[4].name, "unattributed");
  double sum_s = 0.0;
  for (const auto& span : spans) sum_s += span.wall_s;
  EXPECT_NEAR(sum_s, 1.0, 1e-12);
}

TEST(SequenceStages, ANewViewIsInNoBar) {
  results::RenderRecord record = frame_cell(1, 0, 0, 1.0).render;
  const std::size_t before = results::html_report::stage_spans(record).size();
  record.stages.push_back(record.stages.front());
  record.stages.back().phase = Phase::new_view;
  EXPECT_EQ(results::html_report::stage_spans(record).size(), before);
}

TEST(FrameChart, PlacesPointsAndLeavesGaps) {
  results::html_report::FrameChart chart;
  chart.title = "a <b>";
  chart.lines = {{"m<1>", 9, {{0.0, 0.0}, {1.0, 10.0}, {2.0, kNan}, {3.0, 5.0}, {4.0, 5.0}}}};
  chart.format = [](double value) { return std::to_string(static_cast<int>(value)); };
  const std::string svg = results::html_report::frame_chart(chart);
  EXPECT_NE(svg.find("a &lt;b&gt;"), std::string::npos);
  EXPECT_NE(svg.find("<g class=\"line-1\">"), std::string::npos);  // eight colours
  EXPECT_NE(svg.find("m&lt;1&gt;, frame 3: 5</title>"), std::string::npos);
  // Frame 0 at the left end and at the bottom, frame 4 at the right end; one gap.
  EXPECT_NE(svg.find("d=\"M70.0 204.0L"), std::string::npos) << svg;
  EXPECT_NE(svg.find("cx=\"608.0\""), std::string::npos) << svg;
  std::size_t moves = 0;
  for (const char c : svg.substr(svg.find("d=\""), svg.find("\"/><circle") - svg.find("d=\""))) {
    moves += c == 'M' ? 1U : 0U;
  }
  EXPECT_EQ(moves, 2U);
  chart.lines[0].points = {{0.0, kNan}};
  EXPECT_EQ(results::html_report::frame_chart(chart), "");
}

/// A page of one sequence with images and a reference per frame.
TEST(SequenceReport, ShowsTimeAndScorePerFrameAndTheFirstImage) {
  const tests::TemporaryFolder folder;
  const auto path = folder.path() / "runs" / "quick" / "20261122T001209Z-0a1b2c";
  perception::Image image = perception::make_rgb_image(8, 6, perception::Encoding::scene_linear);
  {
    auto run = results::RunFolder::open_for_writing(path);
    run.write_run_json(
        {{"schema", 1},
         {"suite", "quick"},
         {"scenes", {{{"id", "box"}, {"frame", 0}}}},
         {"metrics", {"flip", "ssim"}},
         {"references",
          {{{"scene", "box"}, {"frame", 0}, {"transport", "full"}, {"hash", "aa"}},
           {{"scene", "box"}, {"frame", 1}, {"transport", "full"}, {"hash", "bb"}}}}});
    for (int frame = 0; frame < 3; ++frame) {
      const CellRecord cell = frame_cell(1, 0, frame, frame == 0 ? 1.0 : 0.1 * frame);
      std::filesystem::create_directories((path / cell.render.image).parent_path());
      perception::write_exr(path / cell.render.image, {{{"radiance", image}}, {}});
      run.append(cell);
      for (const char* against : {"own", "full"}) {
        for (const char* metric : {"flip", "ssim"}) {
          MetricRecord score = frame_score(cell, metric, 0.25 + 0.125 * frame);
          score.against = against;
          score.reference_hash = frame == 0 ? "aa" : "bb";
          if (std::string(metric) == "flip" && std::string(against) == "own") score.value = 0.125;
          run.append(score);
        }
      }
    }
  }
  const std::string page = results::html_report::html_report(results::load_run(path));
  const auto has = [&](const std::string& text) { return page.find(text) != std::string::npos; };
  EXPECT_TRUE(has("<h3>Time per frame</h3>"));
  EXPECT_TRUE(has("<title>a, frame 2: 200 ms</title>"));
  EXPECT_FALSE(has("<title>a, frame 0: 1.00 s</title>"));
  EXPECT_TRUE(has("<h3>Score per frame</h3>"));
  EXPECT_TRUE(has("aria-label=\"flip (own) per frame\""));
  EXPECT_TRUE(has("aria-label=\"flip (full) per frame\""));
  EXPECT_TRUE(has("aria-label=\"ssim (own = full) per frame\""));
  EXPECT_TRUE(has("<title>a, frame 1: 0.375</title>"));
  EXPECT_TRUE(has("<h4>Next frame</h4>"));
  EXPECT_TRUE(has("hatched: update; plain: render"));
  EXPECT_TRUE(has("Of the sequence its first frame is shown."));
  EXPECT_TRUE(has("<small>worst 0.500 at 2</small>"));
  // The reference of the second frame is no picture of the page.
  EXPECT_TRUE(has("reference: full"));
  std::size_t references = 0;
  for (std::size_t at = page.find("<b>reference: full</b>"); at != std::string::npos;
       at = page.find("<b>reference: full</b>", at + 1)) {
    ++references;
  }
  EXPECT_EQ(references, 1U);
}

TEST(SequenceReport, ShowsSequenceMetricsWithUnitMapAndSharedSettings) {
  const tests::TemporaryFolder folder;
  const auto path = folder.path() / "runs" / "quick" / "20261122T001209Z-0a1b2c";
  const perception::Image image =
      perception::make_rgb_image(8, 6, perception::Encoding::scene_linear);
  perception::Image map =
      perception::make_gray_image(8, 6, "jnd", perception::Encoding::scene_linear);
  {
    auto run = results::RunFolder::open_for_writing(path);
    run.write_run_json({{"schema", 1}, {"suite", "quick"}, {"metrics", {"flicker", "flip"}}});
    for (int frame = 0; frame < 4; ++frame) {
      CellRecord cell = frame_cell(1, 0, frame, 1.0);
      cell.render.transport = "one_bounce";
      cell.render.part = "indirect";
      std::filesystem::create_directories((path / cell.render.image).parent_path());
      perception::write_exr(path / cell.render.image, {{{"radiance", image}}, {}});
      run.append(cell);
      MetricRecord flip = frame_score(cell, "flip", 0.25);
      flip.parameters = {{"ppd", 0.0}, {"start_exposure", std::string("-1.5")}};
      run.append(flip);
      flip.against = "own";
      flip.parameters = {{"start_exposure", std::string("-1.25")}};
      run.append(flip);
      if (frame == 0) continue;
      MetricRecord flicker = frame_score(cell, "flicker", 0.5 * frame);
      if (frame == 1) flicker.map = "maps/flicker.full.exr";
      run.append(flicker);
    }
    std::filesystem::create_directories(path / "maps");
    perception::write_exr(path / "maps/flicker.full.exr", {{{"map", map}}, {}});
  }
  const std::string page = results::html_report::html_report(results::load_run(path));
  const auto has = [&](const std::string& text) { return page.find(text) != std::string::npos; };
  EXPECT_TRUE(has("<b>flicker (full)</b><span>JND</span>"));
  EXPECT_TRUE(has("<title>a, frame 3: 1.50 JND</title>"));
  EXPECT_TRUE(has("<small>worst 1.50 at 3</small>"));
  EXPECT_TRUE(
      has("found from its references: flip (full): start_exposure=-1.5; flip (own, one_bounce "
          "indirect): start_exposure=-1.25."));
  EXPECT_TRUE(has("of flicker, the change from frame to frame, the mean. Beside it"));
  EXPECT_TRUE(has("<h4>flicker</h4>"));  // the strip of its maps
  // The first frame has no score, yet its place: frame 1 is a third of the axis away from the left.
  EXPECT_TRUE(has("<circle cx=\"249.3\"")) << page.substr(page.find("flicker (full)"), 2000);
}

}  // namespace
