#include <fmt/format.h>

#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

/// Runs of a suite whose one renderer is told how long to take.
class CompareVerb : public ProgramTest {
 protected:
  /// @return the run's folder
  std::string run_taking(double seconds) const {
    const std::string suite = write_text(
        "night.yaml",
        fmt::format("schema: 1\nsuite: night\nviewing: {{ppd: 60}}\n"
                    "scenes: [{{id: spot, file: cornell-box-spot, size: [8, 8], "
                    "reference: {{samples: 4}}}}]\n"
                    "methods: [{{id: b, renderer: blank, parameters: {{sleep_s: {}}}}}]\n"
                    "measure: {{repetitions: {{min: 6, max: 6}}}}\nmetrics: [relative-rmse]\n",
                    seconds));
    return discern_json({"run", suite, "--force"}, "run").at("run").get<std::string>();
  }
};

/// Slower by more than the machine itself can get under other work, which the canary answers for.
TEST_F(CompareVerb, TellsASlowerRunByItsExitCode) {
  const std::string before = run_taking(0.02);
  const std::string after = run_taking(0.4);
  const auto slower = discern_json({"compare", before, after}, "compare", 1);
  EXPECT_EQ(slower["counts"]["worse"], 1) << slower.dump(1);
  const auto& change = slower["changes"][0];
  EXPECT_EQ(change["quantity"], "total_s");
  EXPECT_EQ(change["verdict"], "worse");
  EXPECT_GT(change["ratio"]["value"], 1.5);
  EXPECT_EQ(slower["changes"][1]["verdict"], "same");  // the picture is the same
  // What the method was told differs, and is said.
  ASSERT_FALSE(slower["notes"].empty());
  EXPECT_EQ(slower["notes"][0], "differs: b: sleep_s 0.02 -> 0.4");
  EXPECT_EQ(discern_json({"compare", after, before}, "compare")["counts"]["better"], 1);

  const auto text = discern({"compare", before, "night", "--only-changed"});
  EXPECT_EQ(text.exit.code, 1);
  EXPECT_NE(text.stdout_text.find("- worse"), std::string::npos) << text.stdout_text;
  EXPECT_EQ(text.stdout_text.find("relative-rmse"), std::string::npos) << text.stdout_text;
}

TEST_F(CompareVerb, NothingComparedIsNoSuccess) {
  const std::string before = run_taking(0.001);
  const std::string other = write_text(
      "night.yaml",
      "schema: 1\nsuite: night\nviewing: {ppd: 60}\nmetrics: [relative-rmse]\n"
      "scenes: [{id: spot, file: cornell-box-spot, size: [8, 8], reference: {samples: 4}}]\n"
      "methods: [{id: c, renderer: blank}]\n");
  const auto run = discern_json({"run", other, "--force"}, "run").at("run").get<std::string>();
  const auto json = discern_json({"compare", before, run}, "compare", 4);
  EXPECT_EQ(json["counts"]["not_measured"], 2);
}

TEST_F(CompareVerb, BadInput) {
  expect_refused({"compare", "a", "b", "--alpha", "2"},
                 "--alpha: \"2\" is not accepted; accepted: a share between 0 and 1, such as 0.05 "
                 "or 5%");
  expect_refused({"compare", "a", "b", "--time-effect", "0%"},
                 "--time-effect: \"0%\" is not accepted; accepted: a share between 0 and 1, such "
                 "as 0.05 or 5%");
}

}  // namespace
}  // namespace tests
