#include "suites/psychophysics/psychophysics_suite.h"

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "suites/suite_file.h"
#include "tests/expect_error.h"
#include "tests/expect_input_error.h"
#include "tests/suites/psychophysics/small_suite.h"

namespace suites::psychophysics {
namespace {

using results::psychophysics::Half;
using tests::input_error_of;
using tests::parsed;
using tests::small_suite_with;

TEST(PsychophysicsSuite, ReadsStimuliThresholdsAndModels) {
  const PsychophysicsSuite suite = parsed(tests::kSmallSuite);
  ASSERT_EQ(suite.experiments.size(), 2U);
  const SuiteExperiment& patches = suite.experiments[0];
  EXPECT_EQ(patches.facts.axis.unit, "%");
  EXPECT_EQ(patches.trials[1].facts.x, 10.0);
  EXPECT_NEAR(patches.trials[1].facts.observed_db, 20.0 * std::log10(0.02), 1e-12);
  EXPECT_EQ(patches.trials[0].facts.sd_db, 3.0);
  EXPECT_TRUE(patches.trials[0].plain);   // no pedestal
  EXPECT_FALSE(patches.trials[1].plain);  // masked
  // log10 dL = 0.745 on 100 cd/m2: dL / L = 10^(0.745 - 2), as Ferwerda's photopic Weber fraction.
  const Trial& spot = suite.experiments[1].trials[0];
  EXPECT_NEAR(spot.facts.mean_cd_m2, 100.0, 1e-9);
  EXPECT_NEAR(spot.facts.observed_db, 20.0 * (0.745 - 2.0), 1e-12);
  ASSERT_EQ(suite.models.size(), 5U);
  EXPECT_EQ(suite.models[3].id, "metric[csf_gain=0.5]");
  EXPECT_EQ(kind_of(suite.models[1]), "pattern");
}

TEST(PsychophysicsSuite, PairsHoldTheTargetAndNothingElse) {
  const Trial trial = parsed(tests::kSmallSuite).experiments[0].trials[1];
  const perception::StimulusPair pair = trial.pairs.front()(0.05);
  double most = 0.0;
  for (std::size_t i = 0; i < pair.test.pixels.size(); ++i) {
    most = std::max(most, std::abs(static_cast<double>(pair.test.pixels[i]) -
                                   static_cast<double>(pair.reference.pixels[i])));
  }
  // The patch's peak lies between four pixels of the 60 x 60.
  EXPECT_NEAR(most / 30.0, 0.05, 0.005);
  EXPECT_EQ(trial.pairs.front()(0.0).test.pixels, pair.reference.pixels);
  const Trial spot = parsed(tests::kSmallSuite).experiments[1].trials[0];
  const perception::StimulusPair steps = spot.pairs.front()(25.0);
  EXPECT_NEAR(steps.test.at(24, 24) / steps.reference.at(24, 24), 26.0, 1e-3);
  EXPECT_EQ(steps.test.at(0, 0), steps.reference.at(0, 0));
}

TEST(PsychophysicsSuite, ResolvedReadsTheSameAgain) {
  const PsychophysicsSuite suite = parsed(tests::kSmallSuite);
  const PsychophysicsSuite again = parsed(suite.resolved);
  EXPECT_EQ(again.resolved, suite.resolved);
  ASSERT_EQ(again.models.size(), suite.models.size());
  EXPECT_EQ(again.models[4].id, suite.models[4].id);
  EXPECT_EQ(summary_of(again.models[4]).find("visible-difference,csf=daly"), 0U);
}

TEST(PsychophysicsSuite, EveryOneOfTheCatalogueReads) {
  std::size_t count = 0;
  for (const std::string& name : catalog_suite_names()) {
    const std::filesystem::path path = find_suite(name);
    if (!is_psychophysics_suite(path)) continue;
    EXPECT_NO_THROW(read_psychophysics_suite(path)) << path;
    ++count;
  }
  EXPECT_GE(count, 5U);
}

TEST(PsychophysicsSuite, BadInputIsNamedWithItsPlace) {
  EXPECT_EQ(input_error_of([] {
              parsed(small_suite_with("castle-achromatic}", "castle}"));
            }).find("small.yaml:25:20: unknown contrast sensitivity function \"castle\""),
            0U)
      << input_error_of([] { parsed(small_suite_with("castle-achromatic}", "castle}")); });
  EXPECT_EQ(input_error_of([] { parsed(small_suite_with("pedestal: 10%", "pedestal: 130%")); }),
            "small.yaml:14:75: pedestal is 130%; accepted: 0% to 100%");
  EXPECT_EQ(input_error_of([] { parsed(small_suite_with("axis: pedestal", "axis: pedestals")); }),
            "small.yaml:11:11: unknown axis \"pedestals\"; did you mean \"pedestal\"? known: none, "
            "frequency, pedestal, mask, field");
  EXPECT_EQ(input_error_of([] { parsed(small_suite_with("db: -40, ", "db: -40, contrast: 1, ")); }),
            "small.yaml:13:88: observed has contrast and db; one of them is accepted");
  EXPECT_EQ(input_error_of([] { parsed(small_suite_with("[plain, masked]", "[plain, msked]")); }),
            "small.yaml:16:66: unknown stimulus \"msked\"; did you mean \"masked\"? known: plain, "
            "masked");
  EXPECT_EQ(input_error_of([] { parsed(small_suite_with("    ppd: 30\n", "")); }),
            "small.yaml:12:9: ppd is missing; it stands here or in the experiment");
  EXPECT_EQ(input_error_of([] { parsed(small_suite_with("id: masked", "id: plain")); }),
            "small.yaml:14:9: stimulus id \"plain\" is used twice");
  EXPECT_EQ(input_error_of([] {
              parsed(small_suite_with("gabor: {f", "gabr: {f"));
            }).find("small.yaml:13:9: stimulus needs one of: modelfest, gabor, edge, spot"),
            0U);
}

TEST(PsychophysicsSuite, AnElevationIsOverAThresholdOfItsExperiment) {
  const std::string text = small_suite_with("{contrast: 2%}", "{elevation: 3, over: plan}");
  EXPECT_EQ(
      input_error_of([&] { parsed(text); }),
      "small.yaml:14:111: unknown stimulus with a threshold of its own \"plan\"; did you mean "
      "\"plain\"? known: plain");
  const std::string good = small_suite_with("{contrast: 2%}", "{elevation: 3, over: plain}");
  const auto stimulus = parsed(good).experiments[0].facts.stimuli[1];
  EXPECT_NEAR(stimulus.observed_db, 20.0 * std::log10(3.0), 1e-12);
  EXPECT_EQ(stimulus.over, "plain");
}

TEST(PsychophysicsSuite, HalvesAreOfAllStimuliOrNone) {
  EXPECT_NE(input_error_of([] {
              parsed(small_suite_with("{id: plain,", "{id: plain, half: calibration,"));
            }).find("stimulus \"masked\" belongs to no half, others do"),
            std::string::npos);
  EXPECT_NE(input_error_of([] {
              parsed(small_suite_with("{id: plain,", "{id: plain, half: first,"));
            }).find("unknown half \"first\"; known: calibration, held_out"),
            std::string::npos);
}

TEST(PsychophysicsSuite, AnAnchorIsAStimulusWithAThreshold) {
  const std::string text =
      small_suite_with("reads: jnd_max,", "reads: jnd_max, at: {stimulus: plains},");
  EXPECT_NE(input_error_of([&] { parsed(text); })
                .find("unknown stimulus \"plains\"; did you mean \"plain\"? known: plain, masked, "
                      "spot"),
            std::string::npos);
}

TEST(PsychophysicsSuite, ASlopeNeedsPlacesAboveZero) {
  const std::string text = small_suite_with("lower: {by_db: 1}", "slope: {between: [0, 1]}");
  EXPECT_NE(input_error_of([&] { parsed(text); }).find("stimulus \"plain\" lies at 0 there"),
            std::string::npos);
}

}  // namespace
}  // namespace suites::psychophysics
