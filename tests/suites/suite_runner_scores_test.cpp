#include <algorithm>
#include <map>

#include "perception/image_file.h"
#include "renderers/scene/scene_file.h"
#include "suites/reference_images.h"
#include "tests/expect_input_error.h"
#include "tests/suites/runs_fixture.h"

namespace {

using results::CellRecord;
using StoredRun = results::Run;
using results::Status;
using suites::RunOutcome;
using suites::Suite;
using tests::kBlankAndPath;
using tests::Runs;

TEST_F(Runs, MethodsAreScoredAgainstTheirOwnTransportAndAgainstAllLight) {
  const RunOutcome outcome =
      run("methods: [{id: direct, renderer: path, parameters: {transport: direct}}]\n"
          "budgets: [{samples: 64}]\nmetrics: [relmse]\n");
  const StoredRun made = results::load_run(outcome.run_folder);
  std::map<std::string, double> value;
  for (const auto& score : made.metrics) value[score.against] = score.value.value_or(-1.0);
  ASSERT_EQ(value.size(), 2U);
  // Indirect light is missing: what the viewer misses is far more than the method's own noise.
  EXPECT_GT(value["full"], 10.0 * value["own"]);
  EXPECT_EQ(made.info->at("references").size(), 2U);
}

TEST_F(Runs, ARendererThatCannotMakeTheReferenceIsRefusedBeforeTheRun) {
  Suite made = suite("methods: [{id: b, renderer: blank}]\nmetrics: [relmse]\n");
  made.scenes[0].reference.renderer = "blank";
  // `blank` claims direct light only: there is no reference of all light by it.
  const std::string message = tests::input_error_of([&] { tests::run(made, options()); });
  EXPECT_EQ(message.find("reference: renderer \"blank\" cannot render transport full"), 0U);
}

TEST_F(Runs, AReferenceThatCannotBeReadIsToldAndTheTimesAreKept) {
  const Suite made = suite("methods: [{id: b, renderer: blank}]\nmetrics: [relmse]\n");
  tests::run(made, options());
  for (const auto& entry :
       std::filesystem::directory_iterator(folder_.path() / "results" / "references")) {
    std::filesystem::resize_file(entry.path() / "reference.exr", 100);
  }
  suites::RunOptions forced = options();
  forced.force = true;
  const RunOutcome outcome = tests::run(made, forced);
  EXPECT_EQ(outcome.failed_references, 2U);
  EXPECT_EQ(outcome.finished_repetitions, 1U);
  EXPECT_EQ(suites::exit_code_of(outcome), 3);
  const StoredRun stored = results::load_run(outcome.run_folder);
  EXPECT_TRUE(stored.metrics.empty());
  for (const auto& reference : stored.info->at("references")) {
    EXPECT_NE(reference.at("reason").get<std::string>().find("reference.exr"), std::string::npos);
  }
}

TEST_F(Runs, EvaluationMakesOnlyWhatIsMissing) {
  const Suite made =
      suite("methods: [{id: pt, renderer: path}]\nbudgets: [{samples: 4}]\nmetrics: [relmse]\n");
  const RunOutcome first = tests::run(made, options());
  const double before = results::load_run(first.run_folder).metrics.at(0).value.value_or(0);
  EXPECT_EQ(suites::evaluate_run(made, first.run_folder, options(), {}), 0U);
  suites::RunOptions forced = options();
  forced.force = true;
  EXPECT_EQ(suites::evaluate_run(made, first.run_folder, forced, {}), 2U);
  EXPECT_EQ(results::load_run(first.run_folder).metrics.at(0).value.value_or(0), before);
  Suite more = made;
  more.metrics.emplace_back(metrics::parse_metric_choice("ssim", {}));
  EXPECT_EQ(suites::evaluate_run(more, first.run_folder, options(), {}), 2U);
}

TEST_F(Runs, AReferenceWithMoreSamplesMakesScoresAnew) {
  const char* methods =
      "methods: [{id: pt, renderer: path}, {id: b, renderer: blank}]\n"
      "budgets: [{samples: 4}]\nmetrics: [relmse]\n";
  suites::RunOptions part = options();
  part.filter = "pt";
  const Suite made = suite(methods);
  const RunOutcome first = tests::run(made, part);
  const double before = results::load_run(first.run_folder).metrics.at(0).value.value_or(0);
  const auto scene = renderers::scene::read_scene_file(made.scenes[0].file).at_frame(0);
  suites::ReferenceKey key;
  key.scene = &scene;
  key.size_px = made.scenes[0].size_px;
  suites::ReferenceStore(options().results_root).extend(key, 64, devices_of(options()), {});
  tests::run(made, options());
  const StoredRun again = results::load_run(first.run_folder);
  EXPECT_EQ(again.metrics.at(0).cell.find("walls.pt"), 0U);
  EXPECT_NE(again.metrics.at(0).value.value_or(0), before);
}

TEST_F(Runs, AFinishedRunIsScoredAnewOnceItsReferenceHasMoreSamples) {
  const char* methods =
      "methods: [{id: pt, renderer: path}]\nbudgets: [{samples: 4}]\nmetrics: [relmse]\n";
  const RunOutcome first = run(methods);
  const results::MetricRecord before = results::load_run(first.run_folder).metrics.at(0);
  EXPECT_EQ(run(methods).new_repetitions, 0U);
  const Suite made = suite(methods);
  const auto scene = renderers::scene::read_scene_file(made.scenes[0].file).at_frame(0);
  suites::ReferenceKey key;
  key.scene = &scene;
  key.size_px = made.scenes[0].size_px;
  suites::ReferenceStore(options().results_root).extend(key, 64, devices_of(options()), {});
  const RunOutcome again = run(methods);
  EXPECT_EQ(again.new_repetitions, 0U);
  const StoredRun after = results::load_run(again.run_folder);
  EXPECT_EQ(after.folder, first.run_folder);
  EXPECT_NE(after.metrics.at(0).value, before.value);
  EXPECT_LT(after.metrics.at(0).noise_floor.value(), before.noise_floor.value());
  EXPECT_EQ(after.info->at("references").at(0).at("pixel_hash"),
            after.metrics.at(0).reference_pixel_hash);
}

TEST_F(Runs, TheNoiseFloorOfRelmseIsTheRelativeVarianceOfTheReference) {
  const RunOutcome outcome =
      run("methods: [{id: pt, renderer: path}]\nbudgets: [{samples: 4}]\nmetrics: [relmse]\n");
  const results::MetricRecord score = results::load_run(outcome.run_folder).metrics.at(0);
  const auto file = perception::read_image_file(folder_.path() / "results" / "references" /
                                                score.reference_hash / "reference.exr");
  const perception::Image& mean = file.parts.at(0).image;
  const auto variance = std::find_if(file.parts.begin(), file.parts.end(),
                                     [](const auto& part) { return part.name == "variance"; });
  ASSERT_NE(variance, file.parts.end());
  double expected = 0.0;
  for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
    const auto r = static_cast<double>(mean.pixels[i]);
    expected += static_cast<double>(variance->image.pixels[i]) / (r * r + 0.01);
  }
  expected /= static_cast<double>(mean.pixels.size());
  // One draw of unit variance per pixel, weighted very unevenly: a factor of two.
  EXPECT_GT(score.noise_floor.value(), 0.5 * expected);
  EXPECT_LT(score.noise_floor.value(), 2.0 * expected);
}

TEST_F(Runs, ADamagedImageCostsItsOwnScoresOnly) {
  const char* methods =
      "methods: [{id: pt, renderer: path}, {id: b, renderer: blank}]\n"
      "budgets: [{samples: 4}]\nmetrics: [relmse]\n";
  const RunOutcome first = run(methods);
  const StoredRun made = results::load_run(first.run_folder);
  const auto image = made.folder / made.cells.at(0).render.image;
  std::filesystem::resize_file(image, std::filesystem::file_size(image) / 2);
  std::filesystem::remove(made.folder / "metrics.jsonl");
  const RunOutcome again = run(methods);
  EXPECT_EQ(again.failed_scores, 1U);
  EXPECT_EQ(suites::exit_code_of(again), 3);
  const StoredRun after = results::load_run(again.run_folder);
  EXPECT_EQ(after.metrics.size(), 2U);
  const auto reason = after.info->at("score_failures").at(0).get<std::string>();
  EXPECT_NE(reason.find(image.string()), std::string::npos) << reason;
}

}  // namespace
