// What a suite may say of figures, and the exact words for what it may not.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "results/figures/figures.h"
#include "tests/expect_input_error.h"
#include "tests/results/figures/synthetic_suite.h"

namespace {

using results::RunValues;
using results::figures::FigureKind;
using results::figures::FigureSpec;
using test_figures::figures_of;
using test_figures::SyntheticSuite;
using tests::input_error_of;

std::string reading_error(const std::string& yaml) {
  return input_error_of([&] { figures_of(yaml); });
}

TEST(FigureReader, ReadsEveryField) {
  const auto figures = figures_of(
      "- {id: fig10, kind: error-vs-parameter, x: vals, y: [relmse, flip@full], log: [y],\n"
      "   methods: [val, \"val-hard[vals=2..30]\"], scenes: horse, budgets: [fixed],\n"
      "   title: \"Fig. 10\", size_cm: [12, 8]}\n"
      "- {id: grid, kind: image-grid, against: own,\n"
      "   crops: [{x: 0.25, y: 0.5, width: 0.25, height: 0.125}]}\n");
  ASSERT_EQ(figures.size(), 2U);
  const FigureSpec& first = figures[0];
  EXPECT_EQ(first.kind, FigureKind::error_vs_parameter);
  EXPECT_EQ(first.x.text, "vals");
  EXPECT_EQ(first.y.at(1).text, "flip@full");
  EXPECT_EQ(first.methods.at(1).text, "val-hard[vals=2..30]");
  EXPECT_EQ(first.scenes.at(0).text, "horse");
  EXPECT_EQ(first.is_log_x, false);
  EXPECT_EQ(first.is_log_y, true);
  EXPECT_EQ(first.width_cm, 12.0);
  EXPECT_TRUE(first.has_height);
  EXPECT_EQ(figures[1].against, "own");
  EXPECT_FALSE(figures[1].is_log_y.has_value());
  EXPECT_EQ(figures[1].crops.at(0).height, 0.125);
}

TEST(FigureReader, JsonGivesTheSameFigures) {
  const auto figures = figures_of(
      "- {id: a, kind: error-vs-parameter, x: vals, y: relmse, log: [x], title: \"A: \\\"b\\\"\"}\n"
      "- {id: b, kind: false-colour, metric: flip, scenes: [horse], size_cm: [10, 6]}\n"
      "- {id: c, kind: image-grid, crops: [{x: 0.1, y: 0.2, width: 0.3, height: 0.4}]}\n"
      "- {id: d, kind: stage-stack}\n");
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const FigureSpec& figure : figures) json.push_back(to_json(figure));
  const auto again = results::figures::figures_from_json(json, "run.json");
  nlohmann::ordered_json json_again = nlohmann::ordered_json::array();
  for (const FigureSpec& figure : again) json_again.push_back(to_json(figure));
  EXPECT_EQ(json.dump(), json_again.dump());
  EXPECT_EQ(again.at(0).title, "A: \"b\"");
  EXPECT_EQ(base::to_string(again.at(0).y.at(0).place), "run.json");
}

TEST(FigureReader, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(reading_error("- {id: a, kind: paretto, y: relmse}"),
            "suite.yaml:1:17: unknown kind of figure \"paretto\"; did you mean \"pareto\"? "
            "known: error-vs-parameter, error-vs-time, error-chain, pareto, stage-stack, "
            "image-grid, false-colour, series");
  EXPECT_EQ(reading_error("- {id: ../a, kind: pareto, y: relmse}"),
            "suite.yaml:1:8: figure id \"../a\" is no file name; accepted: letters, digits, . _ -, "
            "not starting with . or -");
  EXPECT_EQ(reading_error("- {id: a, kind: stage-stack}\n- {id: a, kind: stage-stack}"),
            "suite.yaml:2:8: two figures have the id \"a\"");
  EXPECT_EQ(reading_error("- {id: a, kind: series, y: links, log: [x]}"),
            "suite.yaml:1:41: the x axis of series has no numbers of its own; accepted: y");
  EXPECT_EQ(reading_error("- {id: a, kind: pareto, y: relmse, size_cm: [2, 8]}"),
            "suite.yaml:1:46: size_cm is 2; accepted: 4 ... 100");
  EXPECT_EQ(reading_error("- {id: a, kind: image-grid, crops: [{x: 0.9, y: 0, width: 0.2, height: "
                          "0.1}]}"),
            "suite.yaml:1:37: crop [0.9, 0] + [0.2, 0.1] leaves the image; accepted: fractions of "
            "it, 0 ... 1");
  EXPECT_EQ(reading_error("- {id: a, kind: error-vs-parameter, y: relmse}"),
            "suite.yaml:1:3: figure needs \"x\"; a error-vs-parameter figure is nothing without "
            "it");
  EXPECT_EQ(reading_error("- {id: a, kind: pareto, y: relmse, methods: []}"),
            "suite.yaml:1:45: methods is an empty list; leave it out for all");
}

TEST(FigureReader, RefusesFieldsOfOtherKinds) {
  const std::string error = reading_error("- {id: a, kind: stage-stack, y: relmse}");
  EXPECT_EQ(error.substr(0, error.find(';')), "suite.yaml:1:30: unknown key \"y\"");
  EXPECT_NE(reading_error("- {id: a, kind: pareto, y: relmse, crops: []}").find("crops"),
            std::string::npos);
}

/// A plan without records: one scene, a sweep, two metrics.
class BeforeARun : public testing::Test {
 protected:
  BeforeARun() {
    suite_.add_scene("horse");
    suite_.add_method("val[vals=2]");
    suite_.set_metrics({"relmse", "flip"});
    auto info = *suite_.run().info;
    info["planned_cells"] = {
        {{"cell", "c"}, {"scene", "horse"}, {"method", "val[vals=2]"}, {"budget", "fixed"}}};
    run_ = suite_.run();
    run_.info = std::make_shared<const nlohmann::ordered_json>(info);
  }
  std::string check(const std::string& yaml) const {
    const RunValues planned(run_);
    return input_error_of([&] { results::figures::check_figures(figures_of(yaml), planned); });
  }
  SyntheticSuite suite_;
  results::Run run_;
};

TEST_F(BeforeARun, NamesOfThePlanAreChecked) {
  EXPECT_EQ(check("- {id: a, kind: error-vs-parameter, x: vals, y: relmse, methods: [val]}"),
            "no error");
  EXPECT_EQ(check("- {id: a, kind: pareto, y: relmse, methods: [vall]}"),
            "suite.yaml:1:46: unknown method \"vall\"; did you mean \"val\"? known: val");
  EXPECT_EQ(check("- {id: a, kind: pareto, y: relmse, scenes: [hose]}"),
            "suite.yaml:1:45: unknown scene \"hose\"; did you mean \"horse\"? known: horse");
  EXPECT_EQ(check("- {id: a, kind: pareto, y: total_s}"),
            "suite.yaml:1:28: y of pareto is a score, which \"total_s\" is not; scores here: "
            "relmse, flip");
  EXPECT_EQ(check("- {id: a, kind: pareto, y: relmse, x: vals}"),
            "suite.yaml:1:39: x of pareto is a time, which \"vals\" is not; accepted: total_s, "
            "next_frame_s, new_view_s, ..., or a stage");
  EXPECT_NE(check("- {id: a, kind: error-chain, y: relms, methods: [val, val]}").find("relmse"),
            std::string::npos);
  EXPECT_NE(check("- {id: a, kind: false-colour, metric: flop}").find("did you mean \"flip\""),
            std::string::npos);
}

TEST_F(BeforeARun, CountersAndStagesMayComeLater) {
  EXPECT_EQ(check("- {id: a, kind: series, y: links}"), "no error");
  EXPECT_NE(check("- {id: a, kind: series, y: score.links}"), "no error");
}

}  // namespace
