#include "suites/suite_file.h"
#include "suites/psychophysics/psychophysics_suite.h"
#include "suites/suite_methods.h"

#include <gtest/gtest.h>

#include "tests/expect_input_error.h"
#include "tests/suites/test_suite.h"
#include "tests/temporary_folder.h"

namespace {

using suites::Budget;
using suites::Suite;

class SuiteFile : public testing::Test {
 protected:
  Suite read(const std::string& text, const std::string& profile = "") {
    return tests::suite_from(folder_.path(), text, profile);
  }
  Suite with_methods(const std::string& rest) { return read(tests::kSuiteHead + rest); }
  std::string error_of(const std::string& text, const std::string& profile = "") {
    return tests::input_error_of([&] { read(text, profile); });
  }
  std::string error_with(const std::string& rest) { return error_of(tests::kSuiteHead + rest); }

  tests::TemporaryFolder folder_;
};

TEST_F(SuiteFile, ReadsWhatIsWrittenAndFillsTheRest) {
  const Suite suite = with_methods(
      "methods: [{id: pt, renderer: path, parameters: {max_depth: 3}}]\n"
      "budgets: [{samples: 8}, {time: 1.5s}, fixed]\n"
      "measure: {seeds: 4, repetitions: {min: 5, max: 30, until: 2%}, warmup: 0, order: blocks,\n"
      "          timeout: 10m, memory: 2GiB}\n"
      "metrics: [relmse, flip]\n");
  EXPECT_EQ(suite.name, "trial");
  ASSERT_EQ(suite.scenes.size(), 1U);
  EXPECT_EQ(suite.scenes[0].file, folder_.path() / "walls.yaml");
  EXPECT_EQ(suite.scenes[0].size_px, (base::SizePx{16, 16}));
  EXPECT_EQ(suite.scenes[0].reference.samples, 16);
  ASSERT_EQ(suite.methods.size(), 1U);
  EXPECT_EQ(suite.methods[0].choice.preset, "best");
  EXPECT_EQ(suite.methods[0].choice.parameters.integer("max_depth"), 3);
  ASSERT_EQ(suite.budgets.size(), 3U);
  EXPECT_EQ(suite.budgets[0].name(), "8spp");
  EXPECT_EQ(suite.budgets[1].name(), "1.5s");
  EXPECT_EQ(suite.budgets[2].name(), "fixed");
  EXPECT_EQ(suite.measure.seeds, 4);
  EXPECT_EQ(suite.measure.min_repetitions, 5);
  EXPECT_EQ(suite.measure.max_repetitions, 30);
  EXPECT_DOUBLE_EQ(suite.measure.until_relative_spread, 0.02);
  EXPECT_EQ(suite.measure.warmup, 0);
  EXPECT_FALSE(suite.measure.is_interleaved);
  EXPECT_DOUBLE_EQ(suite.measure.timeout_s, 600.0);
  EXPECT_EQ(suite.measure.memory_bytes, std::int64_t{2} << 30);
  EXPECT_TRUE(suite.exposure_from_scene);
  ASSERT_EQ(suite.metrics.size(), 2U);
  EXPECT_EQ(text_of(suite.metrics[1]), "flip");
}

TEST_F(SuiteFile, JsonIsValidInput) {
  const Suite suite = read(
      R"({"schema": 1, "suite": "trial", "viewing": {"ppd": 60},
          "scenes": [{"id": "walls", "file": "walls.yaml"}],
          "methods": [{"id": "b", "renderer": "blank"}]})");
  EXPECT_EQ(suite.methods.at(0).id, "b");
  ASSERT_EQ(suite.budgets.size(), 1U);
  EXPECT_EQ(suite.budgets[0], Budget{});
}

TEST_F(SuiteFile, SweepValuesAreNamedInTheIdAndKeptAsColumns) {
  const Suite suite = with_methods(
      "methods: [{id: pt, renderer: path, matrix: {max_depth: [2, 4], sampling: [mis]}}]\n");
  ASSERT_EQ(suite.methods.size(), 2U);
  EXPECT_EQ(suite.methods[0].id, "pt[max_depth=2,sampling=mis]");
  EXPECT_EQ(suite.methods[1].id, "pt[max_depth=4,sampling=mis]");
  EXPECT_EQ(suite.methods[1].base_id, "pt");
  ASSERT_EQ(suite.methods[1].sweep.size(), 2U);
  EXPECT_EQ(suite.methods[1].sweep[0].first, "max_depth");
  EXPECT_EQ(std::get<std::int64_t>(suite.methods[1].sweep[0].second), 4);
  EXPECT_EQ(suite.methods[1].choice.parameters.integer("max_depth"), 4);
}

TEST_F(SuiteFile, ResolvedFormReadsBackAsTheSameSuite) {
  const Suite suite =
      read(tests::kSuiteHead +
               "methods:\n"
               "  - {id: pt, renderer: path, preset: paper, matrix: {max_depth: [2, 4]}}\n"
               "  - {id: own, renderer: path, parameters: {samples: 3}, budgets: [fixed]}\n"
               "  - {id: b, renderer: blank, parameters: {radiance: 0.125}}\n"
               "budgets: [{samples: [8, 16]}, {time: 0.25s}]\n"
               "measure: {repetitions: {min: 2, max: 9, until: 7%}, timeout: 90s, memory: 100MB}\n"
               "metrics: [\"relmse,trim=0.001\"]\n"
               "profiles: {smoke: {measure: {seeds: 3}}}\n",
           "smoke");
  const std::string text = suites::resolved_yaml(suite);
  const Suite again = suites::parse_suite(base::parse_document(text, "resolved.yaml"),
                                          folder_.path() / "elsewhere" / "resolved.yaml", "");
  EXPECT_EQ(suites::resolved_yaml(again), text);
  EXPECT_EQ(again.profile, "smoke");
  EXPECT_EQ(again.measure.seeds, 3);
  EXPECT_EQ(again.budgets, suite.budgets);
  ASSERT_EQ(again.methods.size(), suite.methods.size());
  for (std::size_t i = 0; i < suite.methods.size(); ++i) {
    EXPECT_EQ(again.methods[i].id, suite.methods[i].id);
    EXPECT_EQ(again.methods[i].budgets, suite.methods[i].budgets);
    EXPECT_EQ(again.methods[i].choice.preset, suite.methods[i].choice.preset);
    EXPECT_EQ(again.methods[i].choice.parameters.to_text(),
              suite.methods[i].choice.parameters.to_text());
  }
  EXPECT_DOUBLE_EQ(again.viewing.pixels_per_degree, suite.viewing.pixels_per_degree);
  EXPECT_EQ(hash_of(again.viewing), hash_of(suite.viewing));
  EXPECT_EQ(again.scenes[0].file, suite.scenes[0].file);
}

TEST_F(SuiteFile, AnOwnReferenceAndTheScenesOfAMethodReadBack) {
  std::string head = tests::kSuiteHead;
  const std::string sampled = "{renderer: path, samples: 16}";
  head.replace(head.find(sampled), sampled.size(),
               "{samples: 16, own: {renderer: instant-radiosity, preset: paper, seed: 7,"
               " parameters: {vpls: 64}}}");
  const std::string methods =
      "methods: [{id: ir, renderer: instant-radiosity, preset: paper, scenes: [walls]}]\n"
      "metrics: [mse]\n";
  const Suite suite = read(head + methods);
  EXPECT_EQ(suite.scenes[0].reference.renderer, "path");
  ASSERT_TRUE(suite.scenes[0].reference.own.has_value());
  EXPECT_EQ(suite.scenes[0].reference.own->seed, 7U);
  EXPECT_EQ(suite.scenes[0].reference.own->choice.parameters.integer("vpls"), 64);
  EXPECT_EQ(suite.methods[0].scenes, std::vector<std::string>{"walls"});
  const std::string text = suites::resolved_yaml(suite);
  EXPECT_EQ(suites::resolved_yaml(read(text)), text);

  head.replace(head.find("vpls: 64"), 8, "part: all");
  EXPECT_NE(error_of(head + methods).find("leave out part"), std::string::npos);
  EXPECT_NE(error_with("methods: [{id: a, renderer: path, scenes: [wals]}]\n")
                .find("method \"a\": unknown scene \"wals\"; did you mean \"walls\"?"),
            std::string::npos);
  EXPECT_NE(error_with("methods: [{id: a, renderer: path, scenes: []}]\n").find("scenes is empty"),
            std::string::npos);
}

TEST_F(SuiteFile, ProfilesReplaceWhatTheyName) {
  const std::string text =
      tests::kSuiteHead +
      "methods: [{id: pt, renderer: path, parameters: {max_depth: 8}}, {id: b, renderer: blank}]\n"
      "budgets: [{samples: 64}]\n"
      "measure: {seeds: 4, repetitions: {min: 5, max: 30}}\n"
      "profiles:\n"
      "  smoke:\n"
      "    scenes: {walls: {size: [8, 4], reference: {samples: 2}}}\n"
      "    measure: {seeds: 1, repetitions: {min: 1, max: 1}}\n"
      "    budgets: [{samples: 2}]\n"
      "    methods: {pt: {parameters: {max_depth: 2}}}\n"
      "  half: {}\n";
  const Suite smoke = read(text, "smoke");
  EXPECT_EQ(smoke.profile, "smoke");
  EXPECT_EQ(smoke.scenes[0].size_px, (base::SizePx{8, 4}));
  EXPECT_EQ(smoke.scenes[0].reference.samples, 2);
  EXPECT_EQ(smoke.scenes[0].reference.renderer, "path");
  EXPECT_EQ(smoke.measure.seeds, 1);
  EXPECT_EQ(smoke.measure.max_repetitions, 1);
  EXPECT_EQ(smoke.budgets[0].name(), "2spp");
  EXPECT_EQ(smoke.methods[0].choice.parameters.integer("max_depth"), 2);
  const Suite half = read(text, "half");
  EXPECT_EQ(half.scenes[0].size_px, (base::SizePx{16, 16}));
  EXPECT_EQ(half.profile, "half");
  EXPECT_EQ(read(text).profile, "");
}

TEST_F(SuiteFile, ProfileErrorsNameThePlaceEvenOfProfilesNotAskedFor) {
  const std::string methods = "methods: [{id: pt, renderer: path}]\n";
  EXPECT_EQ(error_with(methods + "profiles: {smoke: {scenes: {wals: {size: [8, 8]}}}}\n"),
            "trial.yaml:6:29: unknown scene \"wals\"; did you mean \"walls\"? known: walls");
  EXPECT_EQ(error_of(tests::kSuiteHead + methods + "profiles: {smoke: {}}\n", "smok"),
            "trial.yaml: unknown profile \"smok\"; did you mean \"smoke\"? known: smoke");
  EXPECT_EQ(error_of(tests::kSuiteHead + methods, "smoke"),
            "trial.yaml: unknown profile \"smoke\"; this suite has no profiles");
  EXPECT_NE(error_with(methods + "profiles: {smoke: {measure: {sedes: 1}}}\n").find("sedes"),
            std::string::npos);
}

TEST_F(SuiteFile, UnknownNamesAreErrorsWithPlaceAndNearestName) {
  std::string known;
  for (const renderers::RendererInfo& info : renderers::renderer_list()) {
    known += (known.empty() ? "" : ", ") + info.name;
  }
  EXPECT_EQ(error_with("methods: [{id: pt, renderer: pth}]\n"),
            "trial.yaml:5:30: unknown renderer \"pth\"; did you mean \"path\"? known: " + known);
  EXPECT_NE(
      error_with("methods: [{id: pt, renderer: path, preset: papr}]\n").find("trial.yaml:5:44: "),
      std::string::npos);
  const std::string parameter =
      error_with("methods: [{id: pt, renderer: path, parameters: {max_dept: 3}}]\n");
  EXPECT_NE(parameter.find("trial.yaml:5:"), std::string::npos) << parameter;
  EXPECT_NE(parameter.find("did you mean \"max_depth\"?"), std::string::npos) << parameter;
  const std::string metric = error_with("methods: [{id: pt, renderer: path}]\nmetrics: [relmes]\n");
  EXPECT_NE(metric.find("trial.yaml:6:11: "), std::string::npos) << metric;
  EXPECT_NE(metric.find("did you mean \"relmse\"?"), std::string::npos) << metric;
  const std::string key = error_with("methods: [{id: pt, renderer: path}]\nbudgts: [fixed]\n");
  EXPECT_NE(key.find("trial.yaml:6:1: "), std::string::npos) << key;
  EXPECT_NE(key.find("did you mean \"budgets\"?"), std::string::npos) << key;
}

TEST_F(SuiteFile, SceneNamesAreLookedUpInTheCatalogue) {
  const std::string text = error_of(
      "{schema: 1, suite: t, viewing: {ppd: 60}, scenes: [{id: a, file: cornel-box}],\n"
      " methods: [{id: b, renderer: blank}]}");
  EXPECT_NE(text.find("trial.yaml:1:66: "), std::string::npos) << text;
  EXPECT_NE(text.find("did you mean \"cornell-box\"?"), std::string::npos) << text;
}

TEST_F(SuiteFile, BudgetsAreSamplesTimeOrFixed) {
  const std::string methods = "methods: [{id: pt, renderer: path}]\n";
  EXPECT_EQ(error_with(methods + "budgets: [{error: {metric: flip, at: 0.05}}]\n"),
            "trial.yaml:6:10: budget by error: \"flip\" is none of this suite's metrics; add it "
            "to them");
  EXPECT_EQ(error_with(methods + "budgets: [{samples: 0}]\n"),
            "trial.yaml:6:21: samples is 0; accepted: 1 or more");
  EXPECT_EQ(error_with(methods + "budgets: [{samples: 4}, {samples: 4}]\n"),
            "trial.yaml:6:25: budget 4spp is listed twice");
  EXPECT_EQ(error_with(methods + "budgets: [{samples: 4, time: 1s}]\n"),
            "trial.yaml:6:11: a budget needs exactly one of: samples, time, error");
  EXPECT_NE(error_with(methods + "budgets: [{time: 10}]\n").find("trial.yaml:6:18: "),
            std::string::npos);
  EXPECT_EQ(error_with("methods: [{id: b, renderer: blank, budgets: [{samples: 4}]}]\n"),
            "trial.yaml:5:45: renderer \"blank\" has no progressive unit and runs once; accepted "
            "budgets: fixed, and by time or error with `search` of a parameter");
}

TEST_F(SuiteFile, SearchedSettingsAreNumbersOfTheRenderer) {
  const std::string head = "methods: [{id: pt, renderer: path, search: ";
  EXPECT_EQ(with_methods(head + "samples}]\n").methods[0].search->to, 65536.0);
  const auto read = with_methods(head + "{setting: max_depth, from: 2, to: 9}}]\n").methods[0];
  EXPECT_EQ(*read.search, (suites::SearchedSetting{"max_depth", 2.0, 9.0, true}));
  EXPECT_NE(error_with(head + "max_depht}]\n").find("did you mean \"max_depth\"?"),
            std::string::npos);
  EXPECT_EQ(error_with(head + "{setting: max_depth, to: 9}}]\n"),
            "trial.yaml:5:44: search needs `from`: the parameter declares no such bound above 0");
  EXPECT_EQ(error_with(head + "{setting: samples, from: 9, to: 9}}]\n"),
            "trial.yaml:5:44: search goes from 9 to 9; accepted: from below to");
  EXPECT_NE(error_with("methods: [{id: pt, renderer: path, parameters: {max_depth: 3}, search: "
                       "{setting: max_depth, from: 1, to: 9}}]\n")
                .find("max_depth of method \"pt\" is searched and set here, too; keep one"),
            std::string::npos);
}

TEST_F(SuiteFile, BudgetsOfEqualTimeNameAnotherMethod) {
  const std::string methods = "methods: [{id: a, renderer: path}, {id: b, renderer: path}]\n";
  const suites::Suite suite = with_methods(methods + "budgets: [{samples: 4}, {time: {of: a}}]\n");
  EXPECT_EQ(suites::budgets_in_force(suite.methods[0], suite.budgets).size(), 1U);
  EXPECT_EQ(suites::budgets_in_force(suite.methods[1], suite.budgets).back().name(), "time-of-a");
  EXPECT_EQ(
      error_with(methods + "budgets: [{time: {of: c}}]\n"),
      "trial.yaml:6:10: budget of equal time: unknown method \"c\"; did you mean \"a\"? known: "
      "a, b");
}

TEST_F(SuiteFile, SamplesCannotBeSetByParameterAndBudget) {
  const std::string method = "methods: [{id: pt, renderer: path, parameters: {samples: 4}}]\n";
  EXPECT_EQ(error_with(method + "budgets: [{samples: 8}]\n"),
            "trial.yaml:5:58: samples of method \"pt\" is set by its budgets; leave it out here, "
            "or write budgets: [fixed]");
  EXPECT_EQ(
      with_methods(method + "budgets: [fixed]\n").methods[0].choice.parameters.integer("samples"),
      4);
}

TEST_F(SuiteFile, IdsArePathSafeAndUnique) {
  EXPECT_NE(error_with("methods: [{id: a/b, renderer: blank}]\n")
                .find("trial.yaml:5:16: id \"a/b\" cannot be a file name"),
            std::string::npos);
  EXPECT_EQ(error_with("methods: [{id: b, renderer: blank}, {id: b, renderer: path}]\n"),
            "trial.yaml:5:42: method id \"b\" is used twice");
  EXPECT_EQ(error_with("methods: [{id: b, renderer: path, parameters: {max_depth: 1}, "
                       "matrix: {max_depth: [2]}}]\n"),
            "trial.yaml:5:84: max_depth of method \"b\" is set by parameters and swept, too; keep "
            "one");
}

TEST_F(SuiteFile, ClaimsAndFiguresAreKeptButNotWhatARunIsKnownBy) {
  const std::string rest =
      "methods: [{id: pt, renderer: path}]\nmetrics: [relmse]\nbudgets: [{samples: 4}]\n";
  const Suite plain = with_methods(rest);
  const Suite claiming = with_methods(
      rest +
      "claims: [{id: a, item: \"Table: 2\", says: it, measure: \"median(pt, relmse)\", expect: \"> "
      "0\"}]\nfigures: [{id: f, kind: pareto, y: relmse}]\n");
  const std::string resolved = suites::resolved_yaml(claiming);
  EXPECT_NE(resolved, suites::resolved_yaml(plain));
  EXPECT_EQ(suites::measured_part(resolved), suites::measured_part(suites::resolved_yaml(plain)));
  const Suite again = read(resolved);
  EXPECT_EQ(suites::resolved_yaml(again), resolved);
  ASSERT_EQ(again.claims.size(), 1U);
  EXPECT_EQ(again.claims[0].item, "Table: 2");
  ASSERT_EQ(again.figures.size(), 1U);
}

TEST_F(SuiteFile, SearchedBudgetsAreResolved) {
  const Suite suite = with_methods(
      "methods: [{id: a, renderer: path, budgets: [{samples: 4}]},\n"
      "  {id: b, renderer: path, search: {setting: samples, from: 2, to: 99},\n"
      "   budgets: [{time: 10ms}, {time: {of: a}}, {error: {metric: relmse, at: [0.5, 0.25]}}]}]\n"
      "metrics: [relmse]\nmeasure: {convergence: true}\n");
  const std::string resolved = suites::resolved_yaml(suite);
  const Suite again = read(resolved);
  EXPECT_EQ(suites::resolved_yaml(again), resolved);
  EXPECT_EQ(again.methods[1].budgets, suite.methods[1].budgets);
  EXPECT_EQ(again.methods[1].search, suite.methods[1].search);
  EXPECT_TRUE(again.measure.has_convergence);
}

TEST_F(SuiteFile, GatesAreReadAndChecked) {
  const std::string methods = "metrics: [flip]\nmethods: [{id: b, renderer: blank}]\n";
  const Suite suite = with_methods(
      methods +
      "gates: [{metric: flip.p99, against: full, worse_by: 5%, alpha: 2%, methods: [b]},\n"
      "  {stage: total, slower_by: 10%, at_most: 2s}, {stage: gather/visibility, "
      "slower_by: 5%}]\n");
  ASSERT_EQ(suite.gates.size(), 3U);
  EXPECT_EQ(suite.gates[0].quantity, "flip.p99@full");
  EXPECT_EQ(suite.gates[0].text, "flip.p99@full worse by 5%");
  EXPECT_DOUBLE_EQ(*suite.gates[0].worse_by, 0.05);
  EXPECT_DOUBLE_EQ(suite.gates[0].alpha, 0.02);
  EXPECT_EQ(suite.gates[1].quantity, "total_s");
  EXPECT_EQ(suite.gates[1].text, "total slower by 10%, at most 2 s");
  EXPECT_DOUBLE_EQ(*suite.gates[1].at_most, 2.0);
  EXPECT_EQ(suite.gates[2].quantity, "stage.gather/visibility");
  const std::string resolved = suites::resolved_yaml(suite);
  EXPECT_EQ(suites::resolved_yaml(read(resolved)), resolved);
  // What is done with results is no part of what is measured.
  EXPECT_EQ(suites::measured_part(resolved).find("gates"), std::string::npos);

  EXPECT_EQ(error_with(methods + "gates: [{worse_by: 5%}]\n"),
            "trial.yaml:7:9: a gate has either metric, the name of a score, or stage: total, "
            "next_frame, new_view, each or the name of a stage");
  EXPECT_EQ(error_with(methods + "gates: [{metric: flip}]\n"),
            "trial.yaml:7:9: a gate needs a limit: worse_by, at_most, at_least");
  EXPECT_EQ(error_with(methods + "gates: [{metric: flip, worse_by: 0%}]\n"),
            "trial.yaml:7:34: worse_by is \"0%\"; accepted: more than 0% and up to 10000%");
  EXPECT_EQ(error_with(methods + "gates: [{metric: flip, worse_by: 5%, methods: [c]}]\n"),
            "trial.yaml:7:18: gate: unknown method \"c\"; did you mean \"b\"? known: b");
  EXPECT_EQ(error_with(methods + "gates: [{metric: flip, worse_by: 5%, scenes: []}]\n"),
            "trial.yaml:7:46: scenes is an empty list; accepted: ids, or no scenes");
}

TEST_F(SuiteFile, OtherKindsAreRefusedByName) {
  const std::string methods = "methods: [{id: b, renderer: blank}]\n";
  EXPECT_EQ(error_with(methods + "kind: psychophysics\n"),
            "trial.yaml:6:7: kind is \"psychophysics\"; accepted here: images");
  EXPECT_EQ(error_with(methods + "kind: picture\n"),
            "trial.yaml:6:7: kind is \"picture\"; accepted: images, psychophysics");
}

TEST_F(SuiteFile, MeasureValuesAreCheckedWithUnits) {
  const std::string methods = "methods: [{id: b, renderer: blank}]\n";
  EXPECT_EQ(error_with(methods + "measure: {seeds: 0}\n"),
            "trial.yaml:6:18: seeds is 0; accepted: 1 to 100000");
  EXPECT_EQ(error_with(methods + "measure: {repetitions: {min: 3, max: 2}}\n"),
            "trial.yaml:6:38: max is 2; accepted: 3 to 100000");
  EXPECT_EQ(error_with(methods + "measure: {order: interleavd}\n"),
            "trial.yaml:6:18: unknown order \"interleavd\"; did you mean \"interleaved\"? known: "
            "interleaved, blocks");
  for (const std::string value :
       {"timeout: 10", "timeout: 10parsecs", "memory: 8", "repetitions: {until: 2}"}) {
    EXPECT_NE(error_with(methods + "measure: {" + value + "}\n").find("trial.yaml:6:"),
              std::string::npos)
        << value;
  }
}

TEST_F(SuiteFile, ASuiteMustStateItsViewingConditions) {
  EXPECT_NE(error_of("{schema: 1, suite: t, scenes: [{id: a, file: walls.yaml}],\n"
                     " methods: [{id: b, renderer: blank}]}")
                .find("viewing"),
            std::string::npos);
  EXPECT_EQ(error_of("{schema: 2, suite: t}"), "trial.yaml:1:10: schema is 2; accepted: 1");
}

TEST(SuiteCatalogue, EverySuiteOfTheCatalogueReads) {
  std::size_t count = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(suites::catalog_folder())) {
    if (entry.path().extension() != ".yaml") continue;
    if (suites::psychophysics::is_psychophysics_suite(entry.path())) continue;
    EXPECT_NO_THROW(suites::read_suite(entry.path(), "")) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 1U);
}

TEST(SuiteCatalogue, FindsByNameAndNamesTheNearest) {
  EXPECT_EQ(suites::find_suite("quick").filename(), "quick.yaml");
  EXPECT_NE(tests::input_error_of([] {
              suites::find_suite("quik");
            }).find("unknown suite \"quik\"; did you mean \"quick\"?"),
            std::string::npos);
  EXPECT_EQ(tests::input_error_of([] { suites::find_suite("no/such.yaml"); }),
            "suite file no/such.yaml does not exist");
}

}  // namespace
