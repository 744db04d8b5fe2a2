#include <cmath>
#include <map>
#include <set>

#include "perception/image_file.h"
#include "suites/measurement.h"
#include "tests/suites/runs_fixture.h"

namespace {

using results::CellRecord;
using results::MetricRecord;
using results::Status;
using StoredRun = results::Run;
using suites::RunOutcome;
using suites::Suite;

/// Runs a suite of one scene: frames 0 to 3, of which 0 to 2 look alike.
class Sequences : public tests::Runs {
 protected:
  Suite sequence(const std::string& rest) {
    return tests::suite_from(folder_.path(), tests::kSequenceHead + rest);
  }
  StoredRun run_of(const std::string& rest) {
    return results::load_run(tests::run(sequence(rest), options()).run_folder);
  }
  static std::string one_blank(const std::string& parameters, const std::string& measure) {
    return "methods: [{id: b, renderer: blank, parameters: {" + parameters +
           "}}]\nmeasure: {warmup: 0, " + measure + "}\n";
  }
  /// "0:0 0:1 ...": repetition and frame of every record, with the status if it is not ok.
  static std::string order_of(const std::vector<CellRecord>& records) {
    std::string text;
    for (const CellRecord& record : records) {
      text += (text.empty() ? "" : " ") + std::to_string(record.repetition) + ":" +
              std::to_string(record.render.frame);
      if (record.render.status != Status::ok) text += " " + to_string(record.render.status);
    }
    return text;
  }
};

TEST_F(Sequences, HaveARecordAnImageAndScoresPerFrame) {
  const StoredRun made = run_of(
      "methods: [{id: pt, renderer: path}]\nbudgets: [{samples: 4}]\n"
      "measure: {repetitions: 2, new_view: true}\nmetrics: [relmse, ssim]\n");
  EXPECT_EQ(order_of(made.cells), "0:0 0:1 0:2 0:3 1:0 1:1 1:2 1:3");
  std::set<std::string> images;
  for (const CellRecord& record : made.cells) {
    const results::RenderRecord& render = record.render;
    const bool is_first = render.frame == 0;
    EXPECT_EQ(std::isfinite(render.total_s), is_first);
    EXPECT_EQ(render.next_frame_s.has_value(), !is_first);
    EXPECT_EQ(render.new_view_s.has_value(), is_first);
    EXPECT_TRUE(render.notes.empty());
    images.insert(render.image);
    EXPECT_EQ(std::filesystem::path(render.image).filename(),
              "frame-000" + std::to_string(render.frame) + ".exr");
    EXPECT_EQ(perception::pixel_hash(perception::read_image(made.folder / render.image)),
              render.pixel_hash);
  }
  EXPECT_EQ(images.size(), 4U);  // the second repetition has the same pixels

  // Four frames, two metrics, own and full; the frames that look alike share a reference.
  EXPECT_EQ(made.metrics.size(), 16U);
  std::map<int, std::string> references;
  for (const MetricRecord& score : made.metrics) {
    references[score.frame] = score.reference_hash;
    EXPECT_TRUE(score.value.has_value());
    EXPECT_EQ(!score.map.empty(), score.frame == 0);
  }
  ASSERT_EQ(references.size(), 4U);
  EXPECT_EQ(references[1], references[0]);
  EXPECT_EQ(references[2], references[0]);
  EXPECT_NE(references[3], references[0]);
  EXPECT_EQ(made.info->at("references").size(), 2U);
  EXPECT_EQ(made.info->at("scenes")[0].at("frames"), (nlohmann::json{0, 1, 2, 3}));
}

TEST_F(Sequences, OfARendererWithoutHistoryHaveThePixelsOfColdStarts) {
  const StoredRun made = run_of("methods: [{id: pt, renderer: path}]\nbudgets: [{samples: 4}]\n");
  ASSERT_EQ(made.cells.size(), 4U);
  for (const CellRecord& record : made.cells) {
    const Suite cold =
        tests::suite_from(folder_.path(),
                          "schema: 1\nsuite: cold\nviewing: {ppd: 60}\n"
                          "scenes: [{id: moving, file: moving.yaml, size: [16, 16], frame: " +
                              std::to_string(record.render.frame) +
                              "}]\nmethods: [{id: pt, renderer: path}]\nbudgets: [{samples: 4}]\n");
    const auto records = records_of(tests::run(cold, options()));
    ASSERT_EQ(records.size(), 1U);
    EXPECT_EQ(records[0].render.pixel_hash, record.render.pixel_hash) << record.render.frame;
    EXPECT_EQ(records[0].render.scene_hash, record.render.scene_hash);
  }
}

TEST_F(Sequences, ThatCrashKeepTheFramesBefore) {
  const RunOutcome outcome =
      tests::run(sequence("methods: [{id: bad, renderer: blank, parameters: {behaviour: crash, "
                          "fail_at_frame: 2}}, {id: good, renderer: blank}]\nmetrics: [relmse]\n"),
                 options());
  const StoredRun made = results::load_run(outcome.run_folder);
  EXPECT_EQ(order_of(made.cells), "0:0 0:1 0:2 crash 0:0 0:1 0:2 0:3");
  EXPECT_EQ(made.cells[2].render.reason, "signal 6 (Aborted)");
  EXPECT_FALSE(made.cells[2].render.next_frame_s.has_value());
  EXPECT_EQ(outcome.failed_cells, 1U);
  EXPECT_EQ(outcome.finished_repetitions, 2U);
  EXPECT_EQ(made.metrics.size(), 2U * 2U + 4U * 2U);
  // A failure is kept, too: there is nothing to do again.
  EXPECT_EQ(tests::run(sequence("methods: [{id: bad, renderer: blank, parameters: {behaviour: "
                                "crash, fail_at_frame: 2}}, {id: good, renderer: blank}]\nmetrics: "
                                "[relmse]\n"),
                       options())
                .new_repetitions,
            0U);
}

TEST_F(Sequences, TimeoutsAreThoseOfOneFrame) {
  // Together the frames take longer than each of them may.
  const StoredRun slow = run_of(one_blank("sleep_s: 0.2", "timeout: 600ms"));
  EXPECT_EQ(order_of(slow.cells), "0:0 0:1 0:2 0:3");
  const StoredRun hung =
      run_of(one_blank("behaviour: hang, fail_at_frame: 1", "timeout: 200ms, repetitions: 3"));
  EXPECT_EQ(order_of(hung.cells), "0:0 0:1 timeout");
  EXPECT_EQ(hung.cells[1].render.reason, "no answer within 200 ms");
}

TEST_F(Sequences, MemoryIsWatchedInEveryFrame) {
  // More than a worker under the sanitizers takes before it has done anything, about 300 MiB.
  const StoredRun made =
      run_of(one_blank("behaviour: allocate, fail_at_frame: 2", "memory: 800MiB"));
  EXPECT_EQ(order_of(made.cells), "0:0 0:1 0:2 out_of_memory");
}

TEST_F(Sequences, GoOnAfterPixelsThatAreNoNumbers) {
  const StoredRun made =
      run_of(one_blank("behaviour: \"nan\", fail_at_frame: 1", "seeds: 1") + "metrics: [relmse]\n");
  EXPECT_EQ(order_of(made.cells), "0:0 0:1 non_finite 0:2 0:3");
  EXPECT_EQ(made.metrics.size(), 8U);
}

TEST_F(Sequences, WhatTheDeviceLacksStopsNeitherTheWorkerNorTheSuite) {
  const RunOutcome outcome = tests::run(
      sequence("methods: [{id: poor, renderer: blank, parameters: {behaviour: unsupported}},\n"
               "  {id: later, renderer: blank, parameters: {behaviour: unsupported, "
               "fail_at_frame: 1}},\n  {id: good, renderer: blank}]\nmeasure: {repetitions: 2}\n"),
      options());
  const StoredRun made = results::load_run(outcome.run_folder);
  EXPECT_EQ(order_of(made.cells),
            "0:0 unsupported 0:0 0:1 unsupported 0:0 0:1 0:2 0:3 1:0 1:1 1:2 1:3");
  EXPECT_EQ(made.cells[0].render.reason, "blank: asked to lack what the method needs");
  EXPECT_EQ(outcome.failed_cells, 0U);
  EXPECT_EQ(outcome.skipped_cells, 2U);
  EXPECT_EQ(suites::exit_code_of(outcome), 0);
}

TEST_F(Sequences, AnInterruptInTheMiddleMakesTheRepetitionAgain) {
  const Suite made = sequence(one_blank("sleep_s: 0.05, radiance: 1", "repetitions: 2"));
  const RunOutcome stopped =
      suites::run_suite(made, options(), [&](const suites::Progress& progress) {
        const auto file = folder_.path() / "results" / "runs";
        if (progress.done != 1 || !std::filesystem::exists(file)) return;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(file)) {
          if (entry.path().filename() != "cells.jsonl") continue;
          if (line_count(entry.path()) >= 6) suites::interrupt_requested = true;
        }
      });
  EXPECT_TRUE(stopped.was_interrupted);
  EXPECT_EQ(order_of(records_of(stopped)), "0:0 0:1 0:2 0:3 1:0 1:1");
  EXPECT_EQ(stopped.finished_repetitions, 1U);

  suites::interrupt_requested = false;
  const RunOutcome resumed = tests::run(made, options());
  EXPECT_EQ(resumed.run_folder, stopped.run_folder);
  EXPECT_EQ(resumed.new_repetitions, 1U);
  EXPECT_EQ(resumed.finished_repetitions, 2U);
  EXPECT_EQ(order_of(records_of(resumed)), "0:0 0:1 0:2 0:3 1:0 1:1 1:2 1:3");
  EXPECT_EQ(line_count(resumed.run_folder / "cells.jsonl"), 10U);
}

TEST_F(Sequences, AreScoredAgainOnlyWhereSomethingIsMissing) {
  const Suite made = sequence(one_blank("radiance: 0.2", "seeds: 1") + "metrics: [relmse]\n");
  const RunOutcome first = tests::run(made, options());
  const auto file = first.run_folder / "metrics.jsonl";
  const std::string all = base::read_text_file(file);
  // The last frame's scores are lost: two lines.
  std::size_t end = all.size() - 1;
  for (int i = 0; i < 2; ++i) end = all.rfind('\n', end - 1);
  base::write_text_file(file, all.substr(0, end + 1));
  EXPECT_EQ(suites::evaluate_run(made, first.run_folder, options(), {}), 2U);
  EXPECT_EQ(base::read_text_file(file), all);
}

}  // namespace
