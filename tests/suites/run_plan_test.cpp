#include "suites/run_plan.h"

#include <regex>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "perception/base/names.h"
#include "suites/reference_images.h"
#include "suites/run_description.h"
#include "tests/expect_input_error.h"
#include "tests/suites/test_suite.h"
#include "tests/temporary_folder.h"

namespace {

using suites::RunPlan;
using suites::Suite;

class RunPlanning : public testing::Test {
 protected:
  void read(const std::string& rest) {
    suite_ = tests::suite_from(folder_.path(), tests::kSuiteHead + rest);
    scenes_ = suites::load_scenes(suite_);
  }
  RunPlan plan() const { return suites::make_plan(suite_, scenes_); }

  static std::size_t own(const RunPlan& plan, std::size_t cell, std::size_t frame = 0) {
    return suites::own_reference(plan, plan.cells[cell], plan.cells[cell].frames[frame]);
  }

  tests::TemporaryFolder folder_;
  Suite suite_;
  std::vector<suites::SceneStates> scenes_;
};

TEST_F(RunPlanning, CellsAreScenesThenMethodsThenBudgetsThenSeeds) {
  read(
      "methods: [{id: pt, renderer: path}, {id: b, renderer: blank}]\n"
      "budgets: [{samples: 8}, {time: 2s}]\nmeasure: {seeds: 2}\n");
  const RunPlan made = plan();
  std::vector<std::string> starts;
  for (const auto& cell : made.cells) {
    starts.push_back(cell.name.substr(0, cell.name.rfind('-')));
  }
  // `blank` counts nothing and uses no seed: it runs once, under budget fixed.
  EXPECT_EQ(starts,
            (std::vector<std::string>{"walls.pt.8spp.s1", "walls.pt.8spp.s2", "walls.pt.2s.s1",
                                      "walls.pt.2s.s2", "walls.b.fixed.s1"}));
}

/// Lists of several methods become one list, smaller budgets first: the order of all tables.
TEST_F(RunPlanning, BudgetsOfAllMethodsStandInOrder) {
  read(
      "methods: [{id: b, renderer: blank},\n"
      "          {id: a, renderer: path, budgets: [{samples: [16, 4]}, {time: 2s}]},\n"
      "          {id: c, renderer: path, budgets: [{time: 0.5s}, {samples: [1, 64]}]}]\n");
  const results::Run planned = suites::planned_run(suite_, scenes_, plan());
  EXPECT_EQ(planned.info->at("budgets"),
            nlohmann::ordered_json({"1spp", "4spp", "16spp", "64spp", "0.5s", "2s", "fixed"}));
}

TEST_F(RunPlanning, CellNamesArePathSafeAndDifferWithEverythingThatMakesTheImage) {
  read("methods: [{id: pt, renderer: path, matrix: {max_depth: [2, 3], sampling: [mis]}}]\n");
  const RunPlan made = plan();
  ASSERT_EQ(made.cells.size(), 2U);
  const std::regex pattern(R"(walls\.pt-max_depth-2-sampling-mis\.fixed\.s1-[0-9a-f]{8})");
  EXPECT_TRUE(std::regex_match(made.cells[0].name, pattern)) << made.cells[0].name;
  for (const auto& cell : made.cells) EXPECT_TRUE(base::is_path_safe(cell.name)) << cell.name;

  std::set<std::string> names{made.cells[0].name};
  suite_.scenes[0].size_px = {17, 16};
  names.insert(plan().cells[0].name);
  suite_.scenes[0].size_px = {16, 16};
  const std::vector<suites::SceneStates> states = scenes_;
  renderers::scene::Scene other = scenes_[0].first();
  other.hash.low ^= 1;
  scenes_[0].frames = {std::make_shared<const renderers::scene::Scene>(other)};
  names.insert(plan().cells[0].name);
  scenes_ = states;
  suite_.methods[0].choice.parameters.set("roulette_depth", std::int64_t{9});
  names.insert(plan().cells[0].name);
  EXPECT_EQ(names.size(), 4U);
}

TEST_F(RunPlanning, ValuesThatDoNotFitEachOtherNameTheirMethod) {
  read("methods: [{id: val, renderer: clustered-visibility, parameters: {vpls: 8, vals: 9}}]\n");
  EXPECT_EQ(
      tests::input_error_of([&] { plan(); }),
      "method \"val\": vals is 9: more area lights than the 8 point lights of vpls; accepted: "
      "1 to 8");
}

TEST_F(RunPlanning, EachReferenceIsPlannedOnce) {
  read(
      "methods:\n"
      "  - {id: a, renderer: path}\n"
      "  - {id: b, renderer: path, parameters: {max_depth: 2}}\n"
      "  - {id: c, renderer: path, parameters: {transport: one_bounce}}\n"
      "  - {id: d, renderer: path, parameters: {transport: one_bounce, part: indirect}}\n"
      "  - {id: e, renderer: path, parameters: {transport: one_bounce, geometry_clamp: 4}}\n"
      "metrics: [relmse]\n");
  const RunPlan made = plan();
  ASSERT_EQ(made.references.size(), 3U);
  EXPECT_EQ(made.references[0].claims.transport, renderers::Transport::full);
  EXPECT_EQ(made.references[1].claims.transport, renderers::Transport::one_bounce);
  EXPECT_FALSE(made.references[1].claims.geometry_clamp.has_value());
  EXPECT_DOUBLE_EQ(made.references[2].claims.geometry_clamp.value_or(0), 4.0);
  EXPECT_EQ(own(made, 0), 0U);
  EXPECT_EQ(own(made, 3), 1U);
  EXPECT_EQ(own(made, 4), 2U);
  EXPECT_EQ(suites::full_reference(made, made.cells[4], made.cells[4].frames[0]), 0U);
  for (const auto& reference : made.references) {
    EXPECT_EQ(reference.claims.part, renderers::Part::all);
  }
}

TEST_F(RunPlanning, AMethodIsMeasuredOnItsScenesOnly) {
  read("methods: [{id: a, renderer: blank}, {id: b, renderer: blank, scenes: [walls]}]\n");
  suite_.scenes.push_back(suite_.scenes[0]);
  suite_.scenes[1].id = "walls[height=2]";
  scenes_.push_back(scenes_[0]);
  EXPECT_EQ(plan().cells.size(), 4U) << "walls means walls[height=2], too";
  suite_.scenes[0].id = suite_.scenes[0].base_id = "other";
  ASSERT_EQ(plan().cells.size(), 3U);
  EXPECT_EQ(plan().cells[0].method->id, "a");
  EXPECT_EQ(plan().cells[2].method->id, "b");
  suite_.methods[1].scenes = {"walls[height=3]"};
  EXPECT_EQ(plan().cells.size(), 2U);
}

TEST_F(RunPlanning, AnOwnReferenceIsTheTruthOfThoseClaimsAlone) {
  read(
      "methods:\n"
      "  - {id: full, renderer: path}\n"
      "  - {id: once, renderer: path, parameters: {transport: one_bounce, part: indirect}}\n"
      "metrics: [relmse]\n");
  suites::OwnReference picture{suite_.methods[1].choice, 5};
  picture.choice.parameters.set("part", std::string("all"));
  picture.choice.parameters.set("samples", std::int64_t{3});
  suite_.scenes[0].reference.own = picture;
  const RunPlan made = plan();
  ASSERT_EQ(made.references.size(), 2U);
  EXPECT_FALSE(reference_key(made.references[0]).spec.own.has_value());
  EXPECT_EQ(reference_key(made.references[0]).spec.samples, 16);
  const suites::ReferenceKey own_key = reference_key(made.references[own(made, 1)]);
  ASSERT_TRUE(own_key.spec.own.has_value());
  EXPECT_EQ(own_key.spec.samples, 3);
  EXPECT_EQ(own_key.spec.seed, 5U);

  suite_.scenes[0].reference.own->choice.parameters.set("transport", std::string("diffuse"));
  EXPECT_NE(tests::input_error_of([&] { plan(); }).find("claims what no method here claims"),
            std::string::npos);
}

TEST_F(RunPlanning, WithoutMetricsThereAreNoReferences) {
  read("methods: [{id: a, renderer: path}]\n");
  EXPECT_TRUE(plan().references.empty());
}

TEST_F(RunPlanning, FilterMatchesSceneMethodOrCell) {
  read("methods: [{id: pt, renderer: path, matrix: {max_depth: [2, 3]}}]\n");
  const RunPlan made = plan();
  EXPECT_TRUE(suites::matches_filter(made.cells[0], ""));
  EXPECT_TRUE(suites::matches_filter(made.cells[0], "^walls$"));
  EXPECT_TRUE(suites::matches_filter(made.cells[0], "depth=2"));
  EXPECT_FALSE(suites::matches_filter(made.cells[1], "depth=2"));
  EXPECT_NE(tests::input_error_of([&] {
              suites::matches_filter(made.cells[0], "((");
            }).find("--filter \"((\" is not a regular expression"),
            std::string::npos);
}

TEST_F(RunPlanning, ASequenceIsOneCellAndItsStatesHaveAReferenceEach) {
  suite_ = tests::suite_from(folder_.path(),
                             tests::kSequenceHead +
                                 "methods: [{id: a, renderer: path},\n"
                                 "  {id: b, renderer: path, parameters: {transport: one_bounce}}]\n"
                                 "metrics: [relmse]\n");
  scenes_ = suites::load_scenes(suite_);
  const RunPlan made = plan();
  ASSERT_EQ(made.cells.size(), 2U);
  ASSERT_EQ(made.cells[0].frames.size(), 4U);
  EXPECT_EQ(made.cells[0].frames[3].frame, 3);
  // Frames 0 to 2 look alike; two transports.
  ASSERT_EQ(made.references.size(), 4U);
  EXPECT_EQ(made.references[0].frame, 0);
  EXPECT_EQ(made.references[1].frame, 3);
  for (const std::size_t frame : {0U, 1U, 2U}) {
    EXPECT_EQ(own(made, 0, frame), 0U);
    EXPECT_EQ(own(made, 1, frame), 2U);
  }
  EXPECT_EQ(own(made, 0, 3), 1U);
  EXPECT_EQ(own(made, 1, 3), 3U);
  EXPECT_EQ(reference_key(made.references[1]).scene->hash, scenes_[0].frames[3]->hash);

  // Another last frame makes another cell.
  const std::string name = made.cells[0].name;
  suite_.scenes[0].frames.last = 2;
  EXPECT_NE(plan().cells[0].name, name);
}

TEST_F(RunPlanning, ClaimsFollowTheSceneAndItsFrame) {
  suite_ = tests::suite_from(folder_.path(), tests::kSequenceHead +
                                                 "methods: [{id: a, renderer: path}]\n"
                                                 "metrics: [relmse]\n");
  scenes_ = suites::load_scenes(suite_);
  renderers::RendererInfo info = *suite_.methods[0].choice.info;
  // A bound that depends on where the block is, in 1/m2.
  info.claims = [](const base::Parameters&, const renderers::scene::Scene& scene) {
    renderers::Claims claims;
    claims.geometry_clamp = 10.0 + static_cast<double>(scene.objects.at(1).to_world[3].x);
    return claims;
  };
  suite_.methods[0].choice.info = &info;
  const RunPlan made = plan();
  const auto& frames = made.cells.at(0).frames;
  EXPECT_NEAR(frames[0].claims.geometry_clamp.value(), 9.2, 1e-6);
  EXPECT_GT(frames[3].claims.geometry_clamp.value(), 9.3);
  // All light and the bounded light of two states.
  ASSERT_EQ(made.references.size(), 4U);
  EXPECT_EQ(made.references[own(made, 0, 3)].claims, frames[3].claims);
  EXPECT_NE(own(made, 0, 3), own(made, 0, 0));
}

}  // namespace
