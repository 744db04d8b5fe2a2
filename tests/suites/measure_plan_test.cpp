#include "suites/measure_plan.h"

#include <map>

#include "suites/run_plan.h"
#include "tests/expect_input_error.h"
#include "tests/suites/runs_fixture.h"

namespace {

using suites::MeasurePlan;
using suites::RunOutcome;
using suites::Suite;
using tests::Runs;

class MeasurePlans : public Runs {
 protected:
  Suite read(const std::string& rest, const std::string& profile = "") {
    return tests::suite_from(folder_.path(), tests::kSuiteHead + rest, profile);
  }
  /// How the cells of a method are measured.
  static std::vector<MeasurePlan> plans_of(const Suite& suite, const std::string& method) {
    const std::vector<suites::SceneStates> scenes = suites::load_scenes(suite);
    std::vector<MeasurePlan> plans;
    for (const suites::PlannedCell& cell : suites::make_plan(suite, scenes).cells) {
      if (cell.method->id == method) plans.push_back(cell.measure);
    }
    return plans;
  }
  static std::vector<std::string> cell_names(const Suite& suite) {
    const std::vector<suites::SceneStates> scenes = suites::load_scenes(suite);
    std::vector<std::string> names;
    for (const auto& cell : suites::make_plan(suite, scenes).cells) names.push_back(cell.name);
    return names;
  }
};

/// Of the suite's head, with a measure of the scene's own.
std::string head_with_scene_measure(const std::string& measure) {
  std::string head = tests::kSuiteHead;
  const std::string end = "size: [16, 16],";
  head.replace(head.find(end), end.size(), end + " measure: " + measure + ",");
  return head;
}

TEST_F(MeasurePlans, AMethodChangesWhatItStates) {
  const Suite suite = read(
      "methods:\n"
      "  - {id: timed, renderer: path, measure: {repetitions: {min: 3, max: 9}, seeds: 2,\n"
      "     timeout: 5s, memory: 1GiB}}\n"
      "  - {id: once, renderer: path}\n"
      "budgets: [{samples: 4}]\n"
      "measure: {seeds: 1, repetitions: {min: 1, max: 2, until: 7%}, timeout: 90s}\n");
  const std::vector<MeasurePlan> timed = plans_of(suite, "timed");
  ASSERT_EQ(timed.size(), 2U);  // seeds
  EXPECT_EQ(timed[0].min_repetitions, 3);
  EXPECT_EQ(timed[0].max_repetitions, 9);
  EXPECT_DOUBLE_EQ(timed[0].until_relative_spread, 0.07);
  EXPECT_DOUBLE_EQ(timed[0].timeout_s, 5.0);
  EXPECT_EQ(timed[0].memory_bytes, std::int64_t{1} << 30);
  const std::vector<MeasurePlan> once = plans_of(suite, "once");
  ASSERT_EQ(once.size(), 1U);
  EXPECT_EQ(once[0].min_repetitions, 1);
  EXPECT_EQ(once[0].max_repetitions, 2);
  EXPECT_DOUBLE_EQ(once[0].timeout_s, 90.0);
}

TEST_F(MeasurePlans, TheMethodGoesBeforeTheSceneAndTheSceneBeforeTheSuite) {
  const Suite suite = tests::suite_from(
      folder_.path(), head_with_scene_measure("{repetitions: 4, timeout: 7s}") +
                          "methods: [{id: a, renderer: blank, measure: {repetitions: 2}},\n"
                          "          {id: b, renderer: blank}]\n"
                          "measure: {repetitions: 9, timeout: 1m}\n");
  const MeasurePlan a = plans_of(suite, "a").at(0);
  EXPECT_EQ(a.max_repetitions, 2);
  EXPECT_DOUBLE_EQ(a.timeout_s, 7.0);
  EXPECT_EQ(plans_of(suite, "b").at(0).min_repetitions, 4);
}

TEST_F(MeasurePlans, DoNotNameTheCell) {
  const std::string methods = "methods: [{id: pt, renderer: path";
  const std::string rest = "}]\nbudgets: [{samples: 4}]\n";
  const Suite plain = read(methods + rest);
  EXPECT_EQ(cell_names(plain), cell_names(read(methods + ", measure: {repetitions: 5}" + rest)));
  // A suite without such changes is resolved as before there were any.
  EXPECT_EQ(suites::resolved_yaml(plain).find("\n     measure:"), std::string::npos);
}

TEST_F(MeasurePlans, ReadBackFromTheResolvedSuite) {
  const Suite suite = tests::suite_from(
      folder_.path(), head_with_scene_measure("{memory: 100MB}") +
                          "methods: [{id: pt, renderer: path, matrix: {max_depth: [2, 4]},\n"
                          "           measure: {seeds: 3, repetitions: {min: 2, max: 9, until: "
                          "7%}, timeout: 2m}}]\n"
                          "budgets: [{samples: 4}]\n");
  const std::string text = suites::resolved_yaml(suite);
  const Suite again = suites::parse_suite(base::parse_document(text, "resolved.yaml"),
                                          folder_.path() / "resolved.yaml", "");
  EXPECT_EQ(suites::resolved_yaml(again), text);
  const MeasurePlan plan = plans_of(again, "pt[max_depth=4]").at(2);
  EXPECT_EQ(plan.max_repetitions, 9);
  EXPECT_DOUBLE_EQ(plan.until_relative_spread, 0.07);
  EXPECT_DOUBLE_EQ(plan.timeout_s, 120.0);
  EXPECT_EQ(plan.memory_bytes, 100000000);
}

TEST_F(MeasurePlans, AProfileSaysItForAllOrForOne) {
  const std::string text =
      "methods: [{id: a, renderer: blank, measure: {repetitions: {min: 3, max: 9}, timeout: 5s}},\n"
      "          {id: b, renderer: blank, measure: {repetitions: 6}}, {id: c, renderer: blank}]\n"
      "profiles:\n"
      "  smoke: {measure: {repetitions: 1}}\n"
      "  half: {methods: {a: {measure: {repetitions: {min: 2}}}}}\n"
      "  paper: {measure: {repetitions: 2}, methods: {b: {measure: {repetitions: 8}}}}\n";
  const auto most = [&](const std::string& profile, const std::string& method) {
    return plans_of(read(text, profile), method).at(0).max_repetitions;
  };
  EXPECT_EQ(most("smoke", "a"), 1);
  EXPECT_EQ(most("smoke", "b"), 1);
  EXPECT_DOUBLE_EQ(plans_of(read(text, "smoke"), "a").at(0).timeout_s, 5.0);
  EXPECT_EQ(most("half", "a"), 9);
  EXPECT_EQ(plans_of(read(text, "half"), "a").at(0).min_repetitions, 2);
  EXPECT_EQ(most("half", "b"), 6);
  EXPECT_EQ(most("paper", "a"), 2);
  EXPECT_EQ(most("paper", "b"), 8);
  EXPECT_EQ(most("paper", "c"), 2);
}

TEST_F(MeasurePlans, RefuseWhatIsOfTheWholeSuite) {
  EXPECT_EQ(tests::input_error_of(
                [&] { read("methods: [{id: a, renderer: blank, measure: {order: blocks}}]\n"); }),
            "trial.yaml:5:46: unknown key \"order\"; known: seeds, repetitions, timeout, memory in "
            "measure");
  EXPECT_EQ(
      tests::input_error_of([&] {
        read("methods: [{id: a, renderer: blank, measure: {repetitions: {min: 3, max: 2}}}]\n");
      }),
      "trial.yaml:5:73: max is 2; accepted: 3 to 100000");
}

TEST_F(MeasurePlans, EveryMethodIsRepeatedAsItSaysAndARunGoesOn) {
  const std::string methods =
      "methods: [{id: a, renderer: blank, measure: {repetitions: 3}}, {id: b, renderer: blank}]\n"
      "measure: {warmup: 0, repetitions: 1}\n";
  const RunOutcome outcome = run(methods);
  std::map<std::string, int> repetitions;
  for (const results::CellRecord& record : records_of(outcome)) ++repetitions[record.method];
  EXPECT_EQ(repetitions["a"], 3);
  EXPECT_EQ(repetitions["b"], 1);
  EXPECT_EQ(run(methods).new_repetitions, 0U);
}

TEST_F(MeasurePlans, AMethodsTimeoutIsItsOwn) {
  const RunOutcome outcome =
      run("methods: [{id: slow, renderer: blank, parameters: {behaviour: hang},\n"
          "           measure: {timeout: 200ms}}, {id: b, renderer: blank}]\n"
          "measure: {warmup: 0, timeout: 10m}\n");
  const auto records = records_of(outcome);
  ASSERT_EQ(records.size(), 2U);
  EXPECT_EQ(records[0].render.status, results::Status::timeout);
  EXPECT_EQ(records[1].render.status, results::Status::ok);
}

}  // namespace
