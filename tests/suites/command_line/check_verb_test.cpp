#include "perception/base/document.h"
#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

const std::string kSuite = R"(schema: 1
suite: two-methods
summary: A suite to check.
viewing: {ppd: 60, exposure: scene}
scenes:
  - {id: box, file: cornell-box, size: [32, 24], reference: {renderer: path, samples: 256}}
methods:
  - {id: pt, renderer: path, matrix: {max_depth: [2, 8]}}
  - {id: nothing, renderer: blank}
budgets: [{samples: 4}, {time: 1s}]
measure: {seeds: 2}
metrics: [relmse, flip]
profiles: {smoke: {scenes: {box: {size: [16, 16]}}, measure: {seeds: 1}}}
)";

const std::string kMoving = R"(schema: 1
scene: moving
camera: {position: [0, 1, -3], look_at: [0, 1, 1], up: [0, 1, 0], vertical_fov_deg: 40}
materials: {white: {albedo: 0.5}}
objects:
  - {name: block, box: {min: [-0.3, 0, 0], max: [0.3, 0.6, 0.6]}, material: white,
     animation: {keys: [{frame: 0, translate: [-0.8, 0, 0]}, {frame: 4, translate: [0.8, 0, 0]}]}}
lights: [{name: key, type: point, position: [0, 1.5, 0], intensity: [3, 3, 3]}]
)";

using CheckVerb = ProgramTest;

TEST_F(CheckVerb, ResolvesScenesMethodsCellsAndReferences) {
  const auto json = discern_json({"check", write_text("a.yaml", kSuite)}, "check");
  EXPECT_EQ(json["suite"], "two-methods");
  EXPECT_EQ(json["scenes"][0]["faces"], 32);
  EXPECT_EQ(json["scenes"][0]["size_px"], (nlohmann::json{32, 24}));
  EXPECT_EQ(json["methods"].size(), 3U);
  EXPECT_EQ(json["viewing"]["ppd"], 60.0);
  // Two path methods x two budgets x two seeds, and one cell of blank, which uses no seed.
  EXPECT_EQ(json["cells"].size(), 9U);
  EXPECT_EQ(json["references"][0]["samples"], 256);
  EXPECT_EQ(json["references"][0]["stored"], false);
}

TEST_F(CheckVerb, AppliesProfileSeedsAndFilter) {
  const std::string suite = write_text("a.yaml", kSuite);
  const auto smoke = discern_json({"check", suite, "--profile", "smoke"}, "check");
  EXPECT_EQ(smoke["profile"], "smoke");
  EXPECT_EQ(smoke["scenes"][0]["size_px"], (nlohmann::json{16, 16}));
  EXPECT_EQ(smoke["cells"].size(), 5U);
  const auto three =
      discern_json({"check", suite, "--seeds", "3", "--filter", "max_depth=8"}, "check");
  EXPECT_EQ(three["cells"].size(), 6U);
  EXPECT_EQ(three["references"].size(), 1U);
}

/// A triangle, with extensions that are passed over.
const std::string kGltf = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"extensionsUsed": ["KHR_materials_emissive_strength", "EXT_odd"], "nodes": [{"mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
               "min": [0, 0, 0], "max": [1, 1, 0]}],
"bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri":
"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";

TEST_F(CheckVerb, TellsWhatReadingTheScenesWarnsOf) {
  write_text("a.gltf", kGltf);
  const std::string warning =
      "a.gltf: passed over the glTF extensions EXT_odd, KHR_materials_emissive_strength; "
      "supported: none";
  std::string scene = kMoving;
  const std::size_t from = scene.find("box: {");
  scene.replace(from, scene.find("}, material", from) + 1 - from, "mesh: {file: a.gltf}");
  write_text("s.yaml", scene);
  std::string text = kSuite;
  text.replace(text.find("cornell-box"), 11, "s.yaml");
  text.insert(text.find("methods:"), "  - {id: again, file: s.yaml, size: [8, 8]}\n");
  const std::string suite = write_text("a.yaml", text);

  const auto told = discern({"check", suite});
  EXPECT_EQ(told.exit.code, 0);
  EXPECT_EQ(told.stderr_text, "discern: note: scene box: " + warning + "\n");
  const auto json = discern_json({"check", suite}, "check");
  EXPECT_EQ(json["scenes"][0]["warnings"], nlohmann::json{warning});
  EXPECT_EQ(json["scenes"][1]["warnings"], nlohmann::json{warning});
  const auto without =
      discern_json({"check", write_text("b.yaml", kSuite)}, "check")["scenes"][0]["warnings"];
  EXPECT_EQ(without, nlohmann::json::array());
}

TEST_F(CheckVerb, TheCommandLinesRepetitionsGoBeforeThoseOfMethods) {
  std::string text = kSuite;
  const std::string method = "id: pt, renderer: path,";
  text.replace(text.find(method), method.size(),
               method + " measure: {seeds: 1, repetitions: {min: 3, max: 9}},");
  const std::string suite = write_text("a.yaml", text);
  EXPECT_EQ(schema_problems("suite", base::parse_document(text, "a").to_json().dump()), "");
  const auto own = discern_json({"check", suite}, "check");
  EXPECT_EQ(own["cells"].size(), 5U);
  EXPECT_EQ(own["cells"][0]["repetitions"], (nlohmann::json{3, 9}));
  EXPECT_EQ(own["cells"][4]["repetitions"], (nlohmann::json{1, 1}));
  EXPECT_NE(discern({"check", suite}).stdout_text.find("3 to 9"), std::string::npos);
  const auto asked = discern_json({"check", suite, "--seeds", "2", "--repetitions", "5"}, "check");
  EXPECT_EQ(asked["cells"].size(), 9U);
  EXPECT_EQ(asked["cells"][0]["repetitions"], (nlohmann::json{5, 5}));
}

TEST_F(CheckVerb, AFilterThatMatchesNothingMeasuresNothing) {
  const auto json =
      discern_json({"check", write_text("a.yaml", kSuite), "--filter", "zzz"}, "check", 4);
  EXPECT_EQ(json["status"], "nothing_measured");
}

TEST_F(CheckVerb, PrintsThePlanForAPerson) {
  const auto result = discern({"check", write_text("a.yaml", kSuite)});
  EXPECT_EQ(result.exit.code, 0) << result.stderr_text;
  for (const char* part : {"suite two-methods", "A suite to check.", "60.0 ppd", "relmse, flip",
                           "pt[max_depth=2]", "to be rendered", "9 cells"}) {
    EXPECT_NE(result.stdout_text.find(part), std::string::npos) << part << result.stdout_text;
  }
}

TEST_F(CheckVerb, DryRunPrintsTheSamePlan) {
  const std::string suite = write_text("a.yaml", kSuite);
  const auto checked = discern({"check", suite, "--json"});
  const auto dry = discern({"run", suite, "--dry-run", "--json"});
  EXPECT_EQ(dry.exit.code, 0);
  EXPECT_EQ(dry.stdout_text, checked.stdout_text);
  EXPECT_FALSE(std::filesystem::exists(path("results/runs")));
}

TEST_F(CheckVerb, AnAdHocSuiteIsMadeFromOptions) {
  const auto json = discern_json(
      {"check", "--scene", "cornell-box", "--method", "path", "--method",
       "path,samples=8,max_depth=2", "--samples", "64", "--size", "20x10", "--metric", "mse"},
      "check");
  EXPECT_EQ(json["suite"], "ad-hoc");
  ASSERT_EQ(json["cells"].size(), 2U);
  EXPECT_EQ(json["cells"][0]["budget"], "64spp");
  EXPECT_EQ(json["cells"][1]["budget"], "8spp");
  EXPECT_EQ(json["methods"][1]["parameters"]["max_depth"], 2);
  EXPECT_EQ(json["metrics"], nlohmann::json{"mse"});
  EXPECT_EQ(json["scenes"][0]["size_px"], (nlohmann::json{20, 10}));
}

TEST_F(CheckVerb, EstimatesTheCostOfEveryProfile) {
  const std::string suite = write_text(
      "a.yaml",
      "schema: 1\nsuite: costs\nviewing: {ppd: 60}\n"
      "scenes: [{id: box, file: common-box, size: [16, 16], reference: {samples: 4}}]\n"
      "methods: [{id: b, renderer: blank}, {id: pt, renderer: path}]\nbudgets: [{samples: 1}]\n"
      "metrics: [mse]\n"
      "profiles: {large: {scenes: {box: {size: [32, 32]}}}, timed: {budgets: [{time: 2h}]}}\n");
  const std::string nothing = discern({"check", suite}).stdout_text;
  for (const char* part : {"(none)", "large", "timed", "not measured yet: 2 cells, 2 references",
                           "scores are left out: their cost is not measured"}) {
    EXPECT_NE(nothing.find(part), std::string::npos) << part << nothing;
  }
  EXPECT_EQ(discern({"run", suite}).exit.code, 0);
  const auto costs = discern_json({"check", suite}, "check")["costs"];
  EXPECT_EQ(costs["runs"], 1);
  EXPECT_EQ(costs["references"], 2);
  ASSERT_EQ(costs["profiles"].size(), 3U);
  const auto& as_it_is = costs["profiles"][0];
  const auto& large = costs["profiles"][1];
  const auto& timed = costs["profiles"][2];
  EXPECT_EQ(as_it_is["references"], 0);  // they are stored
  EXPECT_EQ(as_it_is["from"]["same_scene"], 2);
  EXPECT_EQ(large["references"], 2);
  EXPECT_GT(large["references_seconds"], 0.0);
  EXPECT_GT(large["seconds"][0], as_it_is["seconds"][0]);
  EXPECT_EQ(timed["from"]["time_budget"], 1);
  EXPECT_GE(timed["seconds"][0], 7200.0);
  EXPECT_EQ(large["unmeasured"]["cells"], 0);
  const auto one =
      discern_json({"check", suite, "--profile", "timed", "--filter", "^pt$"}, "check");
  ASSERT_EQ(one["costs"]["profiles"].size(), 2U);
  EXPECT_EQ(one["costs"]["profiles"][1]["cells"], 1);
  EXPECT_NE(discern({"check", suite}).stdout_text.find("2 h 00 min"), std::string::npos);
}

TEST_F(CheckVerb, ShowsTheScenesOfASweep) {
  const std::string suite =
      write_text("a.yaml",
                 "schema: 1\nsuite: views\nviewing: {ppd: 60}\nscenes:\n"
                 "  - {id: box, file: common-box, set: {environment: {constant: 0.5}},\n"
                 "     matrix: {view: {as-is: {}, near: {camera: {position: [0, 1, -4]}}},\n"
                 "              height: {path: camera.position.1, values: [1, 1.5]}}}\n"
                 "methods: [{id: b, renderer: blank}]\n"
                 "profiles: {one: {scenes: {box: {matrix: {height: {values: [1.25]}},\n"
                 "                                exclude: [{view: near}]}}}}\n");
  EXPECT_EQ(schema_problems("suite", base::read_document(suite).to_json().dump()), "");
  const auto json = discern_json({"check", suite, "--filter", "view=near"}, "check");
  ASSERT_EQ(json["scenes"].size(), 4U);
  EXPECT_EQ(json["scenes"][3]["id"], "box[view=near,height=1.5]");
  EXPECT_EQ(json["scenes"][3]["base_id"], "box");
  EXPECT_EQ(json["scenes"][3]["sweep"],
            (nlohmann::ordered_json{{"view", "near"}, {"height", 1.5}}));
  EXPECT_EQ(json["scenes"][0]["lights"], 3);
  EXPECT_EQ(json["cells"].size(), 2U);
  const auto one = discern_json({"check", suite, "--profile", "one"}, "check");
  ASSERT_EQ(one["scenes"].size(), 1U);
  EXPECT_EQ(one["scenes"][0]["id"], "box[view=as-is,height=1.25]");
  expect_refused(
      {"check", write_text("b.yaml",
                           "schema: 1\nsuite: views\nviewing: {ppd: 60}\nscenes:\n"
                           "  - {id: box, file: common-box, set: {lights: {spo: {}}}}\n"
                           "methods: [{id: b, renderer: blank}]\n")},
      path("b.yaml") + ":5:48: unknown light \"spo\"; did you mean \"spot\"? known: spot");
}

TEST_F(CheckVerb, ErrorsNameThePlaceAndWhatIsAccepted) {
  const auto refused = [&](const std::string& from, const std::string& to,
                           const std::string& message) {
    std::string text = kSuite;
    text.replace(text.find(from), from.size(), to);
    const std::string file = write_text("bad.yaml", text);
    const auto result = discern({"check", file});
    EXPECT_EQ(result.exit.code, 2) << to;
    EXPECT_EQ(result.stderr_text.find("discern: error: " + file + message), 0U)
        << result.stderr_text;
  };
  refused("summary:", "sumary:", ":3:1: unknown key \"sumary\"");
  refused("renderer: blank", "renderer: blnk",
          ":9:29: unknown renderer \"blnk\"; did you mean \"blank\"?");
  refused("max_depth: [2, 8]", "max_dept: [2, 8]",
          ":8:50: unknown parameter \"max_dept\"; did you mean \"max_depth\"?");
  refused("flip]", "flp]", ":12:19: unknown metric \"flp\"; did you mean \"flip\"?");
  refused("time: 1s", "time: 1",
          ":10:32: duration \"1\" is not a number with a unit; accepted units: ");
  refused("file: cornell-box", "file: cornel-box",
          ":6:21: unknown scene \"cornel-box\"; did you mean \"cornell-box\"?");
}

TEST_F(CheckVerb, RefusesUnknownSuitesProfilesAndMixedOptions) {
  const auto unknown = discern({"check", "no-such-suite"});
  EXPECT_EQ(unknown.exit.code, 2);
  EXPECT_EQ(unknown.stderr_text.find("discern: error: unknown suite \"no-such-suite\""), 0U);
  const std::string suite = write_text("a.yaml", kSuite);
  EXPECT_EQ(discern({"check", suite, "--profile", "smok"}).exit.code, 2);
  expect_refused({"check", suite, "--scene", "furnace", "--size", "8x8"},
                 "--scene, --size cannot be given together with suite \"" + suite + "\"");
  expect_refused({"check"},
                 "nothing to run: accepted: a suite, or at least one --scene and one --method");
}

TEST_F(CheckVerb, ShowsTheFramesAndTheClaimsOfEveryScene) {
  write_text("moving.yaml", kMoving);
  const std::string suite = write_text(
      "a.yaml",
      "schema: 1\nsuite: frames\nviewing: {ppd: 60}\n"
      "scenes:\n  - {id: moving, file: moving.yaml, frames: {first: 0, last: 4, step: 2},"
      " reference: {samples: 4}}\n  - {id: box, file: cornell-box}\n"
      "methods: [{id: pt, renderer: path, parameters: {geometry_clamp: 2.5}}]\n"
      "measure: {new_view: true}\nmetrics: [mse]\n");
  const auto json = discern_json({"check", suite}, "check");
  EXPECT_EQ(json["scenes"][0]["frames"], (nlohmann::json{0, 2, 4}));
  EXPECT_EQ(json["scenes"][1]["frames"], nullptr);
  EXPECT_EQ(json["cells"][0]["frames"], (nlohmann::json{0, 2, 4}));
  EXPECT_EQ(json["cells"][0]["geometry_clamp"], 2.5);
  EXPECT_EQ(json["methods"][0]["claims"].size(), 2U);
  EXPECT_EQ(json["methods"][0]["claims"][1]["scene"], "box");
  EXPECT_EQ(json["measure"]["new_view"], true);
  // Three states and one, all light and the bounded light.
  EXPECT_EQ(json["references"].size(), 8U);
  EXPECT_EQ(json["references"][2]["frame"], 4);
  const std::string text = discern({"check", suite}).stdout_text;
  for (const char* part : {"0 to 4 by 2", "full clamp 2.50", "8 references"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << text;
  }
  expect_refused({"check", write_text("b.yaml",
                                      "schema: 1\nsuite: frames\nviewing: {ppd: 60}\nscenes:\n"
                                      "  - {id: moving, file: moving.yaml, frames: [0, 9]}\n"
                                      "methods: [{id: b, renderer: blank}]\n")},
                 path("b.yaml") +
                     ":5:45: frames go to 9; accepted: 0 to 4, the frames of scene "
                     "\"moving\"");
}

}  // namespace
}  // namespace tests
