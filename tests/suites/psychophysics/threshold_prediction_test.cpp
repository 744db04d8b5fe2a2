#include "suites/psychophysics/threshold_prediction.h"

#include <cmath>

#include <gtest/gtest.h>

#include "perception/threshold_vs_intensity.h"
#include "suites/interruption.h"
#include "tests/suites/psychophysics/small_suite.h"

namespace suites::psychophysics {
namespace {

using results::Status;
using results::psychophysics::PredictionRecord;
using tests::parsed;
using tests::small_suite_with;

double db_of(double contrast) { return 20.0 * std::log10(contrast); }

PredictionRecord ask(const PsychophysicsSuite& suite, std::size_t model, std::size_t experiment,
                     std::size_t stimulus) {
  return predict(suite.models[model], suite.experiments[experiment].trials[stimulus], suite);
}

TEST(ThresholdPrediction, ACsfAnswersPlainPatchesOnly) {
  const PsychophysicsSuite suite = parsed(tests::kSmallSuite);
  const PredictionRecord plain = ask(suite, 0, 0, 0);
  const perception::GaborPatch patch{
      .frequency_cpd = 4.0, .sigma_along_deg = 0.3, .sigma_across_deg = 0.3};
  EXPECT_NEAR(*plain.threshold_db,
              db_of(perception::gabor_threshold(patch, 30.0, "castle-achromatic")), 1e-9);
  const PredictionRecord masked = ask(suite, 0, 0, 1);
  EXPECT_EQ(masked.status, Status::unsupported);
  EXPECT_EQ(*masked.reason, "a CSF knows single Gabor patches on a plain field only");
  EXPECT_EQ(ask(suite, 0, 1, 0).status, Status::unsupported);
}

TEST(ThresholdPrediction, TviAnswersSpots) {
  const PsychophysicsSuite suite = parsed(tests::kSmallSuite);
  const double weber = perception::threshold_cd_m2(perception::ThresholdCurve::ward, 100.0) / 100.0;
  EXPECT_NEAR(*ask(suite, 2, 1, 0).threshold_db, db_of(weber), 1e-9);
  EXPECT_EQ(ask(suite, 2, 0, 0).status, Status::unsupported);
}

TEST(ThresholdPrediction, TheFilterDoesNotAnswerMasks) {
  const PsychophysicsSuite suite = parsed(tests::kSmallSuite);
  EXPECT_TRUE(ask(suite, 1, 0, 0).threshold_db);
  EXPECT_EQ(ask(suite, 1, 0, 1).status, Status::unsupported);
}

TEST(ThresholdPrediction, AMetricIsAskedUntilItsCriterion) {
  const PsychophysicsSuite suite = parsed(tests::kSmallSuite);
  const PredictionRecord found = ask(suite, 4, 0, 0);
  ASSERT_TRUE(found.threshold_db);
  EXPECT_GT(found.evaluations, 10);
  const Trial& trial = suite.experiments[0].trials[0];
  const auto& model = std::get<MetricModel>(suite.models[4].question);
  perception::ViewingConditions viewing = perception::default_viewing_conditions();
  viewing.pixels_per_degree = 30.0;
  const double contrast = std::pow(10.0, *found.threshold_db / 20.0);
  EXPECT_NEAR(metrics::response_to(trial.pairs[0](contrast), model.readout, viewing), 1.0, 0.01);
  // Half of the gain needs twice the contrast; a mask raises the threshold.
  EXPECT_NEAR(*ask(suite, 3, 0, 0).threshold_db - *found.threshold_db, db_of(2.0), 0.1);
  EXPECT_GT(*ask(suite, 4, 0, 1).threshold_db, *found.threshold_db + 3.0);
}

TEST(ThresholdPrediction, AnAnchorSetsTheCriterion) {
  // People see `plain` at -40 dB: the anchored metric does, too, whatever its scale.
  const PsychophysicsSuite suite = parsed(
      small_suite_with("metric: visible-difference, reads: jnd_max, matrix: {csf_gain: [0.5, 1]}",
                       "metric: \"pu-psnr,channels=luminance\", at: {stimulus: plain}"));
  const PredictionRecord found = ask(suite, 3, 0, 0);
  ASSERT_TRUE(found.threshold_db);
  EXPECT_NEAR(*found.threshold_db, -40.0, 0.05);
}

TEST(ThresholdPrediction, SaysWhatIsNeverSeen) {
  const PsychophysicsSuite suite = parsed(
      small_suite_with("reads: jnd_max, matrix: {csf_gain: [0.5, 1]}", "reads: jnd_max, at: 1e30"));
  const PredictionRecord unseen = ask(suite, 3, 0, 0);
  EXPECT_EQ(unseen.status, Status::ok);
  EXPECT_FALSE(unseen.threshold_db);
  EXPECT_EQ(*unseen.reason, "not seen at the largest contrast, 1");
}

TEST(ThresholdPrediction, AMetricThatTakesNoLightIsNoJudge) {
  const PsychophysicsSuite suite = parsed(small_suite_with(
      "metric: visible-difference, reads: jnd_max, matrix: {csf_gain: [0.5, 1]}", "metric: ssim"));
  const PredictionRecord refused = ask(suite, 3, 0, 0);
  EXPECT_EQ(refused.status, Status::unsupported);
  EXPECT_TRUE(refused.reason);
}

TEST(ThresholdPrediction, NoiseIsAveragedInDb) {
  const PsychophysicsSuite suite = parsed(R"(schema: 1
suite: noise
kind: psychophysics
experiments:
  - id: edges
    source: tests
    mean_cd_m2: 100
    ppd: 20
    size_deg: 2
    noise_samples: 3
    stimuli:
      - {id: noisy, edge: {ramp_deg: 0.2, noise: white}, observed: {contrast: 0.01}}
      - {id: plain, edge: {ramp_deg: 0.2}, observed: {contrast: 0.002}}
models:
  - {id: metric, metric: visible-difference, reads: jnd_max}
)");
  const PredictionRecord noisy = ask(suite, 0, 0, 0);
  ASSERT_EQ(noisy.samples_db.size(), 3U);
  EXPECT_NE(noisy.samples_db[0], noisy.samples_db[1]);
  EXPECT_NEAR(*noisy.threshold_db,
              (noisy.samples_db[0] + noisy.samples_db[1] + noisy.samples_db[2]) / 3.0, 1e-9);
  EXPECT_EQ(ask(suite, 0, 0, 1).samples_db.size(), 1U);
}

TEST(ThresholdPrediction, StopsWhenAskedTo) {
  const PsychophysicsSuite suite = parsed(tests::kSmallSuite);
  interrupt_requested = true;
  EXPECT_THROW(ask(suite, 4, 0, 0), Interrupted);
  interrupt_requested = false;
}

}  // namespace
}  // namespace suites::psychophysics
