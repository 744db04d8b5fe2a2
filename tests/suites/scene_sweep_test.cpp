#include "suites/scene_sweep.h"

#include <regex>
#include <set>

#include <gtest/gtest.h>

#include "perception/base/names.h"
#include "suites/run_plan.h"
#include "tests/expect_input_error.h"
#include "tests/suites/runs_fixture.h"

namespace {

using results::Status;
using suites::Suite;

/// Suites with one scene entry "walls" that has further keys.
class SceneSweeps : public tests::Runs {
 protected:
  static std::string text_with(const std::string& keys) {
    return "schema: 1\nsuite: trial\nviewing: {ppd: 60}\n"
           "scenes:\n"
           "  - id: walls\n"
           "    file: walls.yaml\n"
           "    size: [16, 16]\n" +
           keys +
           "methods: [{id: b, renderer: blank}, {id: pt, renderer: path}]\n"
           "budgets: [{samples: 2}]\n";
  }
  Suite read(const std::string& keys, const std::string& rest = "",
             const std::string& profile = "") {
    return tests::suite_from(folder_.path(), text_with(keys) + rest, profile);
  }
  std::string error_of(const std::string& keys) {
    return tests::input_error_of([&] { read(keys); });
  }
  /// The message of a suite that reads and whose scenes do not load.
  std::string load_error_of(const std::string& keys) {
    const Suite suite = read(keys);
    return tests::input_error_of([&] { suites::load_scenes(suite); });
  }
  static std::vector<std::string> ids_of(const Suite& suite) {
    std::vector<std::string> ids;
    for (const suites::SuiteScene& scene : suite.scenes) ids.push_back(scene.id);
    return ids;
  }
};

const std::string kTwoAxes =
    "    set: {camera: {vertical_fov_deg: 60}, materials: {white: {albedo: 0.25}}}\n"
    "    matrix:\n"
    "      view: {front: {}, left: {camera: {position: [-1, 1, -3]}}}\n"
    "      height: {path: lights.key.position.1, values: [1, 1.5]}\n";

TEST_F(SceneSweeps, SetChangesTheScene) {
  const Suite suite = read(
      "    set: {camera: {position: [0, 1, -2]}, lights: {key: {intensity: 2}},\n"
      "          materials: {white: {albedo: 0.25}}}\n");
  EXPECT_EQ(ids_of(suite), std::vector<std::string>{"walls"});
  EXPECT_TRUE(suite.scenes[0].sweep.empty());
  const auto states = suites::load_scenes(suite);
  const renderers::scene::Scene& scene = states[0].first();
  EXPECT_EQ(scene.camera.position.z, -2.0F);
  EXPECT_EQ(scene.lights[0].intensity.x, 2.0F);
  EXPECT_EQ(scene.lights[0].position.y, 1.5F);
  EXPECT_EQ(scene.materials[0].albedo.x, 0.25F);
}

TEST_F(SceneSweeps, LabelsAndNumbersMakeScenesOfTheirOwn) {
  const Suite suite = read(kTwoAxes);
  EXPECT_EQ(ids_of(suite),
            (std::vector<std::string>{"walls[view=front,height=1]", "walls[view=front,height=1.5]",
                                      "walls[view=left,height=1]", "walls[view=left,height=1.5]"}));
  const suites::SuiteScene& last = suite.scenes[3];
  EXPECT_EQ(last.base_id, "walls");
  ASSERT_EQ(last.sweep.size(), 2U);
  EXPECT_EQ(last.sweep[0].first, "view");
  EXPECT_EQ(std::get<std::string>(last.sweep[0].second), "left");
  EXPECT_EQ(std::get<double>(last.sweep[1].second), 1.5);
  EXPECT_EQ(std::get<std::int64_t>(suite.scenes[2].sweep[1].second), 1);

  const auto states = suites::load_scenes(suite);
  std::set<std::string> hashes;
  for (const auto& state : states) hashes.insert(state.first().hash.hex());
  EXPECT_EQ(hashes.size(), 4U);
  EXPECT_EQ(states[2].first().camera.position.x, -1.0F);
  EXPECT_EQ(states[2].first().camera.vertical_fov_deg, 60.0F);
  EXPECT_EQ(states[2].first().lights[0].position, glm::vec3(0, 1, 0));
  EXPECT_EQ(states[3].first().lights[0].position, glm::vec3(0, 1.5F, 0));
}

TEST_F(SceneSweeps, ZipExcludeAndIncludeWorkAsForMethods) {
  EXPECT_EQ(ids_of(read("    zip:\n"
                        "      side: {l: {}, r: {camera: {position: {0: 1}}}}\n"
                        "      height: {path: lights.key.position.1, values: [1, 1.5]}\n")),
            (std::vector<std::string>{"walls[side=l,height=1]", "walls[side=r,height=1.5]"}));
  EXPECT_EQ(
      ids_of(read(kTwoAxes + "    exclude: [{view: left, height: 1}, {view: front}]\n"
                             "    include: [{view: front, height: 1.75}]\n")),
      (std::vector<std::string>{"walls[view=left,height=1.5]", "walls[view=front,height=1.75]"}));
}

TEST_F(SceneSweeps, ProfilesLieOverThem) {
  const std::string profiles =
      "profiles:\n"
      "  one: {scenes: {walls: {matrix: {height: {values: [1.25]}}, exclude: [{view: left}],\n"
      "        set: {materials: {white: {albedo: 0.75}}}}}}\n";
  const Suite suite = read(kTwoAxes, profiles, "one");
  EXPECT_EQ(ids_of(suite), std::vector<std::string>{"walls[view=front,height=1.25]"});
  const auto states = suites::load_scenes(suite);
  EXPECT_EQ(states[0].first().materials[0].albedo.x, 0.75F);
  EXPECT_EQ(states[0].first().camera.vertical_fov_deg, 60.0F);
}

TEST_F(SceneSweeps, ResolvedFormReadsBackAsTheSameSuite) {
  const Suite suite =
      read(kTwoAxes +
           "      lit: {path: objects.room.box.facing, values: [in]}\n"
           "      on: {\"yes\": {}, \"1\": {lights: {key: {intensity: [0.1, 2, 1e-7]}}}}\n");
  const std::string text = suites::resolved_yaml(suite);
  const Suite again = suites::parse_suite(base::parse_document(text, "resolved.yaml"),
                                          folder_.path() / "elsewhere" / "resolved.yaml", "");
  EXPECT_EQ(suites::resolved_yaml(again), text);
  ASSERT_EQ(ids_of(again), ids_of(suite));
  const auto states = suites::load_scenes(suite);
  const auto states_again = suites::load_scenes(again);
  for (std::size_t i = 0; i < states.size(); ++i) {
    EXPECT_EQ(again.scenes[i].base_id, "walls");
    EXPECT_EQ(again.scenes[i].sweep, suite.scenes[i].sweep);
    EXPECT_EQ(states_again[i].first().hash, states[i].first().hash);
  }
}

TEST_F(SceneSweeps, ErrorsOfTheSuiteNameThePlace) {
  EXPECT_EQ(error_of("    matrix: {view: {}}\n"), "trial.yaml:8:20: view has no values");
  EXPECT_EQ(error_of("    matrix: {h: {path: a.b, values: []}}\n"),
            "trial.yaml:8:37: h has no values");
  EXPECT_EQ(error_of("    matrix: {view: {a: {}, a: {}}}\n"),
            "trial.yaml:8:28: duplicate key \"a\"; it stands first in line 8");
  EXPECT_EQ(error_of("    matrix: {h: {path: a.b, values: [1, 2, 1]}}\n"),
            "trial.yaml:8:44: h holds 1 twice");
  EXPECT_EQ(error_of("    matrix: {h: {path: a..b, values: [1]}}\n"),
            "trial.yaml:8:24: path \"a..b\" has an empty part; accepted: keys and numbers of list "
            "entries with a dot between them, e.g. lights.key.position.1");
  EXPECT_EQ(error_of("    matrix: {h: {path: a.b, value: [1]}}\n"),
            "trial.yaml:8:17: axis \"h\" has no \"values\"; it is required");
  EXPECT_EQ(error_of("    matrix: {h: [1, 2]}\n"),
            "trial.yaml:8:17: axis \"h\", {label: {what it sets}, ...} or {path, values}, must be "
            "a map of keys and values, not a list");
  EXPECT_EQ(error_of("    matrix: {view: {a/b: {}}}\n"),
            "trial.yaml:8:21: label \"a/b\" cannot be a file name; accepted: letters, digits, . _ "
            "-, not starting with . or -");
  EXPECT_EQ(error_of("    matrix: {view: {a: 3}}\n"),
            "trial.yaml:8:24: a of axis \"view\" must be a map of keys and values, not a whole "
            "number");
  EXPECT_EQ(error_of("    matrix: {view: {front: {}}}\n    exclude: [{view: frnt}]\n"),
            "trial.yaml:9:22: unknown label of view \"frnt\"; did you mean \"front\"? known: "
            "front");
  EXPECT_EQ(error_of("    matrix: {view: {front: {}}}\n    include: [{vew: front}]\n"),
            "trial.yaml:9:16: unknown axis \"vew\"; did you mean \"view\"? known: view");
  EXPECT_EQ(error_of("    set: 3\n"),
            "trial.yaml:8:10: set must be a map of keys and values, not a whole number");
}

TEST_F(SceneSweeps, WhatTheSceneLacksIsAnErrorOfTheSuitesFile) {
  EXPECT_EQ(load_error_of("    set: {lights: {kay: {intensity: 1}}}\n"),
            "trial.yaml:8:20: unknown light \"kay\"; did you mean \"key\"? known: key");
  EXPECT_EQ(load_error_of("    matrix: {view: {a: {camera: {positon: [0, 1, 2]}}}}\n")
                .find("trial.yaml:8:34: unknown key \"positon\"; did you mean \"position\"?"),
            0U);
  EXPECT_EQ(load_error_of("    matrix: {h: {path: lights.key.position.3, values: [1]}}\n"),
            "trial.yaml:8:24: position is a list of 3; accepted: a list, or entries by number from "
            "0; found entry \"3\"");
  EXPECT_EQ(load_error_of("    matrix: {h: {path: lights.key.hight.1, values: [1]}}\n"),
            "trial.yaml:8:24: hight is no list in the scene; it has no entry 1");
  EXPECT_EQ(
      load_error_of("    matrix: {fov: {path: camera.vertical_fov_deg, values: [60, 190]}}\n"),
      "trial.yaml:8:64: vertical_fov_deg 190 is outside (0, 180)");
}

TEST_F(SceneSweeps, CellNamesArePathSafeAndTheFilterSeesTheValues) {
  const Suite suite = read(kTwoAxes);
  const auto states = suites::load_scenes(suite);
  const suites::RunPlan plan = suites::make_plan(suite, states);
  ASSERT_EQ(plan.cells.size(), 8U);
  std::set<std::string> names;
  for (const auto& cell : plan.cells) {
    EXPECT_TRUE(base::is_path_safe(cell.name)) << cell.name;
    names.insert(cell.name);
  }
  EXPECT_EQ(names.size(), 8U);
  const std::regex pattern(R"(walls-view-left-height-1\.5\.pt\.2spp\.s1-[0-9a-f]{8})");
  EXPECT_TRUE(std::regex_match(plan.cells[7].name, pattern)) << plan.cells[7].name;
  EXPECT_TRUE(suites::matches_filter(plan.cells[7], "view=left,height=1\\.5"));
  EXPECT_FALSE(suites::matches_filter(plan.cells[0], "view=left"));
}

TEST_F(SceneSweeps, RunsRenderWhatTheHarnessPlanned) {
  const Suite suite = read(kTwoAxes + "    reference: {samples: 4}\n", "metrics: [mse]\n");
  const suites::RunOutcome outcome = tests::run(suite, options());
  EXPECT_EQ(outcome.cells, 8U);
  EXPECT_EQ(outcome.failed_cells, 0U);
  const results::Run made = results::load_run(outcome.run_folder);
  const auto states = suites::load_scenes(suite);
  ASSERT_EQ(made.cells.size(), 8U);
  std::set<std::string> pixels;
  for (std::size_t i = 0; i < suite.scenes.size(); ++i) {
    const auto& info = made.info->at("scenes").at(i);
    EXPECT_EQ(info.at("id"), suite.scenes[i].id);
    EXPECT_EQ(info.at("base_id"), "walls");
    EXPECT_EQ(info.at("sweep").at("view"), i < 2 ? "front" : "left");
    EXPECT_EQ(info.at("sweep").at("height"), i % 2 == 0 ? 1.0 : 1.5);
    for (const auto& record : made.cells) {
      if (record.scene != suite.scenes[i].id) continue;
      EXPECT_EQ(record.render.status, Status::ok) << record.render.reason.value_or("");
      // The worker read the same scene.
      EXPECT_EQ(record.render.scene_hash, states[i].first().hash.hex());
      if (record.method == "pt") pixels.insert(record.render.pixel_hash);
    }
  }
  EXPECT_EQ(pixels.size(), 4U);
  // All light is the same for both methods, `blank` claims emission alone.
  EXPECT_EQ(made.info->at("references").size(), 8U);
}

}  // namespace
