#include <fstream>
#include <sstream>

#include "tests/suites/command_line/program_test.h"
#include "tests/suites/psychophysics/small_suite.h"

namespace tests {
namespace {

using PsychophysicsVerbs = ProgramTest;

std::string contents(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST_F(PsychophysicsVerbs, CheckSaysWhatWillBeAsked) {
  const std::string file = write_text("small.yaml", kSmallSuite);
  const auto json = discern_json({"check", file}, "psychophysics-check");
  EXPECT_EQ(json["experiments"][0]["stimuli"][0]["observed_db"], -40.0);
  EXPECT_EQ(json["models"].size(), 5U);
  EXPECT_EQ(json["cells"].size(), 15U);
  const std::string text = discern({"check", file, "--filter", "spot"}).stdout_text;
  EXPECT_NE(text.find("5 cells"), std::string::npos) << text;
  EXPECT_NE(text.find("visible-difference,csf_gain=0.5: jnd_max reaches 1"), std::string::npos)
      << text;
  EXPECT_EQ(discern({"check", file, "--filter", "nothing"}).exit.code, 4);
}

TEST_F(PsychophysicsVerbs, RunAnswersReportsAndResumes) {
  const std::string file = write_text("small.yaml", kSmallSuite);
  const auto first = discern_json({"run", file}, "run");
  EXPECT_EQ(first["cells"], 15);
  EXPECT_EQ(first["new_repetitions"], 15);
  const auto& metric = first["experiments"][0]["models"][4];
  EXPECT_EQ(metric["model"], "metric[csf_gain=1]");
  EXPECT_EQ(metric["thresholds"], 2);
  EXPECT_EQ(metric["phenomena"][0]["is_shown"], true);
  EXPECT_EQ(first["experiments"][0]["models"][2]["rms_db"], nullptr);  // TVI knows no patches
  const std::string run = first["run"];
  EXPECT_EQ(schema_problems("psychophysics-cell", contents(run + "/cells.jsonl")), "");
  EXPECT_NE(contents(first["report"]).find("<h2>patches</h2>"), std::string::npos);

  const auto again = discern({"run", file});
  EXPECT_EQ(again.exit.code, 0);
  EXPECT_NE(again.stderr_text.find("every cell was finished before"), std::string::npos);
  EXPECT_NE(again.stdout_text.find("metric[csf_gain=0.5]"), std::string::npos);
  EXPECT_NE(again.stdout_text.find("6 not a question for their model"), std::string::npos);
  discern_json({"report", run}, "report");
  expect_refused({"eval", run}, run +
                                    ": a run of kind psychophysics; accepted here: a run of "
                                    "images");
}

TEST_F(PsychophysicsVerbs, OptionsOfImagesAreRefused) {
  const std::string file = write_text("small.yaml", kSmallSuite);
  expect_refused({"run", file, "--profile", "smoke"},
                 "--profile cannot be given together with suite \"" + file +
                     "\", which is of kind psychophysics; accepted: --filter");
  expect_refused({"check", file, "--seeds", "3"},
                 "--seeds cannot be given together with suite \"" + file +
                     "\", which is of kind psychophysics; accepted: --filter");
}

TEST_F(PsychophysicsVerbs, ADryRunAsksNothing) {
  const std::string file = write_text("small.yaml", kSmallSuite);
  discern_json({"run", file, "--dry-run"}, "psychophysics-check");
  EXPECT_FALSE(std::filesystem::exists(path("results/runs")));
}

TEST_F(PsychophysicsVerbs, TheCatalogueHasThem) {
  const auto json = discern_json({"list", "suites", "--filter", "^psychophysics/"}, "list-suites");
  std::vector<std::string> names;
  for (const auto& suite : json["suites"]) {
    EXPECT_EQ(suite["reason"], nullptr) << suite;
    EXPECT_EQ(suite["kind"], "psychophysics");
    names.push_back(suite["name"]);
  }
  EXPECT_EQ(names, (std::vector<std::string>{
                       "psychophysics/calibration", "psychophysics/contrast-sensitivity",
                       "psychophysics/masking", "psychophysics/modelfest", "psychophysics/rods"}));
}

}  // namespace
}  // namespace tests
