// Scores of what changes from frame to frame, and settings that the frames of a sequence share.
#include <cmath>
#include <map>
#include <set>

#include "perception/image_file.h"
#include "renderers/scene/scene_file.h"
#include "suites/reference_images.h"
#include "tests/expect_input_error.h"
#include "tests/suites/runs_fixture.h"

namespace {

using results::MetricRecord;
using StoredRun = results::Run;
using suites::RunOutcome;
using suites::Suite;

constexpr const char* kOneBlank =
    "methods: [{id: b, renderer: blank, parameters: {radiance: 0.25}}]\n";

/// Runs a suite of one scene: frames 0 to 3, of which 0 to 2 look alike.
class SequenceMetrics : public tests::Runs {
 protected:
  Suite sequence(const std::string& rest) {
    return tests::suite_from(folder_.path(), tests::kSequenceHead + rest);
  }
  StoredRun run_of(const std::string& rest) {
    return results::load_run(tests::run(sequence(rest), options()).run_folder);
  }
  /// The scores of a run's metric by frame.
  static std::map<int, MetricRecord> scores_of(const StoredRun& run, const std::string& metric,
                                               const std::string& against = "full") {
    std::map<int, MetricRecord> scores;
    for (const MetricRecord& record : run.metrics) {
      if (record.metric == metric && record.against == against) scores[record.frame] = record;
    }
    return scores;
  }
  /// Adds samples to the reference of all light of a frame.
  void extend_reference(const Suite& suite, int frame) {
    const auto scene = renderers::scene::read_scene_file(suite.scenes[0].file).at_frame(frame);
    suites::ReferenceKey key;
    key.scene = &scene;
    key.size_px = suite.scenes[0].size_px;
    suites::ReferenceStore(options().results_root).extend(key, 32, devices_of(options()), {});
  }
};

TEST_F(SequenceMetrics, AConstantErrorIsNoFlicker) {
  const StoredRun made = run_of(std::string(kOneBlank) + "metrics: [flicker, mse]\n");
  const auto errors = scores_of(made, "mse");
  const auto flicker = scores_of(made, "flicker");
  ASSERT_EQ(errors.size(), 4U);
  ASSERT_EQ(flicker.size(), 3U);
  for (const auto& [frame, score] : errors) EXPECT_GT(score.value.value(), 1e-4) << frame;
  // The block stands until frame 2 and then moves; what is shown never changes.
  EXPECT_EQ(flicker.at(1).value, 0.0);
  EXPECT_EQ(flicker.at(2).value, 0.0);
  EXPECT_GT(flicker.at(3).value.value(), 0.01);
}

TEST_F(SequenceMetrics, HaveARecordPerFrameFromTheSecondOn) {
  const StoredRun made = run_of(
      "methods: [{id: pt, renderer: path}, {id: d, renderer: path, parameters: {transport: "
      "direct}}]\nbudgets: [{samples: 4}]\nmeasure: {seeds: 2}\nmetrics: [flicker]\n");
  EXPECT_EQ(made.metrics.size(), 3U * 2U * 2U * 2U);
  for (const MetricRecord& score : made.metrics) {
    EXPECT_GT(score.frame, 0);
    EXPECT_GT(score.value.value(), 0.0);
    EXPECT_FALSE(score.context_hash.empty());
    EXPECT_FALSE(score.details.empty());
    const bool is_first_seed = score.cell.find(".s1-") != std::string::npos;
    EXPECT_EQ(!score.map.empty(), is_first_seed && score.frame == 1);
    if (!score.map.empty()) {
      EXPECT_EQ(perception::read_image(made.folder / score.map).width_px, 16);
    }
    // Frames that share a reference have no noise of it in their change.
    const double floor = score.noise_floor.value();
    if (score.frame < 3) {
      EXPECT_EQ(floor, 0.0);
    } else {
      EXPECT_GT(floor, 0.0);
    }
  }
  // What claims all light has one reference; direct light has one of its own.
  const auto value = [&](const std::string& method, const std::string& against) {
    for (const MetricRecord& score : made.metrics) {
      const bool is_of_method = score.cell.find("moving." + method + ".") == 0;
      if (is_of_method && score.frame == 3 && score.against == against) return score.value.value();
    }
    return std::nan("");
  };
  EXPECT_EQ(value("pt", "own"), value("pt", "full"));
  EXPECT_NE(value("d", "own"), value("d", "full"));
}

TEST_F(SequenceMetrics, MapsOfAllFramesAreKeptWhereAsked) {
  const StoredRun made =
      run_of(std::string(kOneBlank) +
             "measure: {seeds: 2}\n"
             "metrics: [{id: all, metric: mse, maps: all_frames, against: full},\n"
             "  {id: some, metric: mse, maps: first_frame, against: full},\n"
             "  {id: change, metric: flicker, maps: all_frames, against: full}]\n");
  std::map<std::string, std::set<int>> kept;
  std::set<std::string> files;
  for (const MetricRecord& score : made.metrics) {
    if (score.map.empty()) continue;
    EXPECT_NE(score.cell.find(".s1-"), std::string::npos);
    EXPECT_EQ(perception::read_image(made.folder / score.map).width_px, 16);
    EXPECT_TRUE(files.insert(score.map).second) << score.map;
    kept[score.id].insert(score.frame);
  }
  EXPECT_EQ(kept["all"], (std::set<int>{0, 1, 2, 3}));
  EXPECT_EQ(kept["some"], (std::set<int>{0}));
  EXPECT_EQ(kept["change"], (std::set<int>{1, 2, 3}));
}

TEST_F(SequenceMetrics, OfABrokenSequenceScoreTheFramesItHas) {
  const StoredRun made = run_of(
      "methods: [{id: bad, renderer: blank, parameters: {behaviour: crash, fail_at_frame: 2}},\n"
      "  {id: first, renderer: blank, parameters: {behaviour: crash, fail_at_frame: 1}}]\n"
      "metrics: [flicker]\n");
  ASSERT_EQ(made.metrics.size(), 2U);
  for (const MetricRecord& score : made.metrics) {
    EXPECT_EQ(score.cell.find("moving.bad."), 0U);
    EXPECT_EQ(score.frame, 1);
  }
}

TEST_F(SequenceMetrics, AFrameThatIsNoNumberCostsTheOneAfterItToo) {
  const StoredRun made = run_of(
      "methods: [{id: b, renderer: blank, parameters: {behaviour: \"nan\", fail_at_frame: 1}}]\n"
      "metrics: [flicker]\n");
  const auto flicker = scores_of(made, "flicker");
  ASSERT_EQ(flicker.size(), 3U);
  EXPECT_FALSE(flicker.at(1).value.has_value());
  EXPECT_FALSE(flicker.at(2).value.has_value());
  EXPECT_TRUE(flicker.at(3).value.has_value());
}

TEST_F(SequenceMetrics, AreMadeAgainWhereAFrameTheyDependOnChanged) {
  const Suite made = sequence(std::string(kOneBlank) + "metrics: [flicker]\n");
  const RunOutcome first = tests::run(made, options());
  EXPECT_EQ(suites::evaluate_run(made, first.run_folder, options(), {}), 0U);
  extend_reference(made, 3);
  EXPECT_EQ(suites::evaluate_run(made, first.run_folder, options(), {}), 1U);
  extend_reference(made, 0);  // that of frames 0, 1 and 2; frame 3 depends on the last of them
  EXPECT_EQ(suites::evaluate_run(made, first.run_folder, options(), {}), 3U);
  EXPECT_EQ(suites::evaluate_run(made, first.run_folder, options(), {}), 0U);
}

TEST_F(SequenceMetrics, ADamagedImageCostsTheFramesThatDependOnIt) {
  const Suite suite = sequence(std::string(kOneBlank) + "metrics: [flicker]\n");
  const StoredRun made = results::load_run(tests::run(suite, options()).run_folder);
  const auto image = made.folder / made.cells.at(1).render.image;
  std::filesystem::resize_file(image, std::filesystem::file_size(image) / 2);
  std::filesystem::remove(made.folder / "metrics.jsonl");
  const RunOutcome again = tests::run(suite, options());
  EXPECT_EQ(again.failed_scores, 4U);  // frames 1 and 2, own and full
  const StoredRun after = results::load_run(again.run_folder);
  ASSERT_EQ(after.metrics.size(), 2U);
  EXPECT_EQ(after.metrics[0].frame, 3);
  const auto reason = after.info->at("score_failures").at(0).get<std::string>();
  EXPECT_NE(reason.find("frame 1 flicker own: "), std::string::npos) << reason;
  EXPECT_NE(reason.find(image.string()), std::string::npos) << reason;
}

TEST_F(SequenceMetrics, SceneOfASingleFrameHasNoneAndIsNoError) {
  const Suite made = tests::suite_from(
      folder_.path(),
      "schema: 1\nsuite: mixed\nviewing: {ppd: 60}\n"
      "scenes:\n  - {id: still, file: walls.yaml, size: [16, 16], reference: {samples: 4}}\n"
      "  - {id: moving, file: moving.yaml, size: [16, 16], frames: [2, 3], reference: {samples: "
      "4}}\n" +
          std::string(kOneBlank) + "metrics: [mse, flicker]\n");
  const StoredRun run = results::load_run(tests::run(made, options()).run_folder);
  EXPECT_EQ(run.metrics.size(), 2U + 4U + 2U);
  const auto flicker = scores_of(run, "flicker");
  ASSERT_EQ(flicker.size(), 1U);
  EXPECT_EQ(flicker.at(3).cell.find("moving."), 0U);
}

/// Start and stop that the scores of a metric were made with, as text, each once.
std::set<std::string> exposures_of(const std::map<int, MetricRecord>& scores) {
  std::set<std::string> exposures;
  for (const auto& [frame, score] : scores) {
    std::string text;
    for (const auto& [name, value] : score.parameters) {
      if (name.find("_exposure") != std::string::npos) text += std::get<std::string>(value) + " ";
    }
    exposures.insert(text);
  }
  return exposures;
}

TEST_F(SequenceMetrics, TheFramesOfASequenceShareTheExposuresOfFlip) {
  const StoredRun made = run_of(
      "methods: [{id: d, renderer: path, parameters: {transport: direct}}]\n"
      "budgets: [{samples: 4}]\nmetrics: [flip, \"flip,start_exposure=-1,stop_exposure=1\"]\n");
  std::map<std::string, std::set<std::string>> shared;
  for (const char* against : {"own", "full"}) {
    const auto scores = scores_of(made, "flip", against);
    ASSERT_EQ(scores.size(), 4U);
    shared[against] = exposures_of(scores);
    EXPECT_EQ(shared[against].size(), 1U);
    EXPECT_EQ(shared[against].begin()->find("auto"), std::string::npos);
    // The details say what the metric did.
    std::set<double> starts;
    for (const auto& [frame, score] : scores) {
      for (const auto& [name, value] : score.details) {
        if (name == "start_exposure") starts.insert(value);
      }
    }
    EXPECT_EQ(starts.size(), 1U);
  }
  // All light is brighter than direct light.
  EXPECT_NE(shared["own"], shared["full"]);
  EXPECT_EQ(exposures_of(scores_of(made, "flip,start_exposure=-1,stop_exposure=1")),
            std::set<std::string>{"-1 1 "});
}

TEST_F(SequenceMetrics, SingleFramesChooseTheirOwnExposures) {
  const StoredRun made =
      results::load_run(run(std::string(kOneBlank) + "metrics: [flip]\n").run_folder);
  EXPECT_EQ(exposures_of(scores_of(made, "flip")), std::set<std::string>{"auto auto "});
  EXPECT_EQ(made.metrics.at(0).context_hash, "");
}

TEST_F(SequenceMetrics, ScoresThatShareSettingsAreMadeAgainTogether) {
  const Suite made = sequence(std::string(kOneBlank) + "metrics: [flip, mse]\n");
  const RunOutcome first = tests::run(made, options());
  extend_reference(made, 3);
  // flip of all four frames, mse of the frame whose reference changed.
  EXPECT_EQ(suites::evaluate_run(made, first.run_folder, options(), {}), 5U);
}

TEST_F(SequenceMetrics, AreRefusedWithoutASequence) {
  const std::string head(tests::kSuiteHead);
  EXPECT_EQ(tests::input_error_of([&] {
              tests::suite_from(folder_.path(),
                                head + std::string(kOneBlank) + "metrics: [mse, flicker]\n");
            }),
            "trial.yaml:6:16: metric \"flicker\" scores sequences, and no scene here has 2 frames; "
            "accepted: a scene with `frames: [first, last]`, or image metrics only");
  EXPECT_EQ(
      tests::input_error_of([&] {
        sequence(std::string(kOneBlank) +
                 "metrics: [flicker]\nprofiles: {tiny: {scenes: {moving: {frames: [1, 1]}}}}\n");
      }),
      "trial.yaml:7:11: metric \"flicker\" scores sequences, and no scene here has 2 frames; "
      "accepted: a scene with `frames: [first, last]`, or image metrics only");
}

TEST_F(SequenceMetrics, AreListedInTheOrderOfTheSuite) {
  const Suite made =
      sequence(std::string(kOneBlank) + "metrics: [mse, \"flicker,tvi_scale=2\", ssim]\n");
  const std::string text = suites::resolved_yaml(made);
  EXPECT_NE(text.find("metrics: [\"mse\", \"flicker,tvi_scale=2\", \"ssim\"]"), std::string::npos);
  const Suite again = suites::parse_suite(base::parse_document(text, "resolved.yaml"),
                                          folder_.path() / "resolved.yaml", "");
  EXPECT_EQ(suites::resolved_yaml(again), text);
}

}  // namespace
