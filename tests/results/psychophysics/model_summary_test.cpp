#include "results/psychophysics/model_summary.h"

#include <cmath>

#include <gtest/gtest.h>

#include "results/psychophysics/model_tables.h"
#include "tests/results/psychophysics/synthetic_experiment.h"

namespace results::psychophysics {
namespace {

PsychophysicsRun run_of_tests() { return tests::synthetic_experiment("/nowhere"); }

TEST(Comparisons, SetElevationsAgainstTheBasesOfTheModelItself) {
  const PsychophysicsRun run = run_of_tests();
  const auto exact = comparisons(run, run.experiments[0], run.models[0]);
  ASSERT_EQ(exact.size(), 4U);
  EXPECT_DOUBLE_EQ(*exact[3].predicted_db, 10.0);
  EXPECT_DOUBLE_EQ(exact[3].residual_db(), 0.0);
  const auto lax = comparisons(run, run.experiments[0], run.models[1]);
  EXPECT_DOUBLE_EQ(lax[0].residual_db(), 6.0);
  // -27 over -34, not over people's -40.
  EXPECT_DOUBLE_EQ(*lax[3].predicted_db, 7.0);
  EXPECT_DOUBLE_EQ(lax[3].residual_db(), -3.0);
}

TEST(Comparisons, LackAnElevationWhoseBaseIsUnseen) {
  PsychophysicsRun run = run_of_tests();
  run.predictions[0].threshold_db.reset();
  const auto exact = comparisons(run, run.experiments[0], run.models[0]);
  EXPECT_FALSE(exact[0].predicted_db);
  EXPECT_FALSE(exact[3].predicted_db);
  EXPECT_TRUE(exact[1].predicted_db);
}

TEST(Misfit, TakesAGainOutOfThresholdsNotOfElevations) {
  const PsychophysicsRun run = run_of_tests();
  const auto lax = comparisons(run, run.experiments[0], run.models[1]);
  const Misfit all = *misfit(lax);
  EXPECT_EQ(all.count, 4U);
  EXPECT_DOUBLE_EQ(*all.gain_db, 6.0);
  EXPECT_DOUBLE_EQ(all.rms_db, std::sqrt((3.0 * 36.0 + 9.0) / 4.0));
  EXPECT_DOUBLE_EQ(all.rms_after_gain_db, std::sqrt(9.0 / 4.0));
  EXPECT_EQ(misfit(lax, Half::calibration)->count, 2U);
  EXPECT_DOUBLE_EQ(misfit(lax, Half::calibration)->rms_db, 6.0);
  EXPECT_DOUBLE_EQ(misfit(lax, Half::held_out)->rms_db, std::sqrt((36.0 + 9.0) / 2.0));
  EXPECT_FALSE(misfit(comparisons(run, run.experiments[0], run.models[2])));
}

TEST(Summarize, CountsWhatBecameOfEveryStimulus) {
  PsychophysicsRun run = run_of_tests();
  run.predictions[4].threshold_db.reset();  // p1 of lax: asked, not seen
  run.predictions[5].status = Status::non_finite;
  run.predictions[5].threshold_db.reset();
  run.predictions.erase(run.predictions.begin() + 6);  // p100 of lax: not yet
  const auto summaries = summarize(run, run.experiments[0]);
  const ModelSummary& lax = summaries[1];
  EXPECT_EQ(lax.stimuli, 4U);
  EXPECT_EQ(lax.unseen, 1U);
  EXPECT_EQ(lax.failed, 1U);
  EXPECT_EQ(lax.missing, 1U);
  EXPECT_FALSE(lax.all);  // the elevation has lost its base
  EXPECT_TRUE(lax.is_answered());
  EXPECT_FALSE(summaries[2].is_answered());
  EXPECT_EQ(summaries[2].unsupported, 4U);
}

TEST(Summarize, SaysWhichPhenomenaAModelShows) {
  PsychophysicsRun run = run_of_tests();
  const auto verdicts = [&](std::size_t model) {
    return summarize(run, run.experiments[0])[model].phenomena;
  };
  const auto exact = verdicts(0);
  EXPECT_NEAR(*exact[0].observed, 0.6, 1e-12);
  EXPECT_NEAR(*exact[0].predicted, 0.6, 1e-12);
  for (const PhenomenonVerdict& verdict : exact) {
    EXPECT_TRUE(*verdict.is_shown) << verdict.phenomenon->id;
  }
  EXPECT_DOUBLE_EQ(*exact[1].predicted, 12.0);
  // 6 dB is a factor 2: one of the two is beyond 1.5, the elevation is not (3 dB).
  const auto lax = verdicts(1);
  EXPECT_TRUE(*lax[0].is_shown);
  EXPECT_FALSE(*lax[3].is_shown);
  EXPECT_DOUBLE_EQ(*lax[3].predicted, 0.5);
  for (const PhenomenonVerdict& verdict : verdicts(2)) EXPECT_FALSE(verdict.is_shown);
  // A flat model has neither the slope nor the order.
  for (int i = 0; i < 3; ++i) run.predictions[static_cast<std::size_t>(i)].threshold_db = -30.0;
  const auto flat = verdicts(0);
  EXPECT_FALSE(*flat[0].is_shown);
  EXPECT_FALSE(*flat[1].is_shown);
  EXPECT_FALSE(flat[2].is_shown);  // equal values have no ranks to correlate
}

TEST(Summarize, ATargetThatIsNotSeenIsBeyondAnyFactor) {
  PsychophysicsRun run = run_of_tests();
  run.predictions[3].threshold_db.reset();
  const auto verdicts = summarize(run, run.experiments[0])[0].phenomena;
  EXPECT_DOUBLE_EQ(*verdicts[3].predicted, 0.5);
  EXPECT_FALSE(*verdicts[3].is_shown);
}

TEST(ModelTable, HasARowPerModelThatAnswersAndNamesTheOthers) {
  const PsychophysicsRun run = run_of_tests();
  const Table table = model_table(run.experiments[0], summarize(run, run.experiments[0]));
  ASSERT_EQ(table.rows.size(), 3U);
  EXPECT_EQ(table.rows[0][0].text, "people");
  EXPECT_EQ(table.rows[0][7].text, "0.60");
  EXPECT_EQ(table.rows[0][8].text, "12.0 dB");
  EXPECT_EQ(table.rows[2][0].text, "lax");
  EXPECT_EQ(table.rows[2][1].text, "4 of 4");
  EXPECT_EQ(table.rows[2][3].text, "6.0");
  EXPECT_EQ(table.columns[7].title, "slope");
  EXPECT_EQ(table.rows[1][7].text, "yes 0.60");
  EXPECT_EQ(table.rows[2][10].text, "no 1 of 2");
  EXPECT_EQ(table.notes.back(), "not a question for: silent");
}

TEST(CalibrationTable, IsSortedByTheCalibrationHalfAlone) {
  PsychophysicsRun run = run_of_tests();
  // The exact model is made worst on the half that must not matter.
  run.predictions[1].threshold_db = 50.0;
  const Table table = calibration_table(run);
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(table.rows[0][0].text, "exact");
  EXPECT_EQ(table.rows[0][0].note, "calibrated");
  EXPECT_EQ(table.rows[0][1].text, "0.0");
  EXPECT_GT(*table.rows[0][2].sort_value, *table.rows[1][2].sort_value);
}

}  // namespace
}  // namespace results::psychophysics
