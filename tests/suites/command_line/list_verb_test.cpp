#include "tests/places.h"
#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

using ListVerb = ProgramTest;

TEST_F(ListVerb, RenderersFollowTheirSchemaAndHoldBothPresets) {
  const auto json = discern_json({"list", "renderers"}, "list-renderers");
  std::vector<std::string> names;
  for (const auto& renderer : json["renderers"]) names.push_back(renderer["name"]);
  EXPECT_NE(std::find(names.begin(), names.end(), "path"), names.end());
  EXPECT_NE(std::find(names.begin(), names.end(), "blank"), names.end());
}

TEST_F(ListVerb, MetricsFollowTheirSchema) {
  const auto json = discern_json({"list", "metrics", "--filter", "^flip$"}, "list-metrics");
  ASSERT_EQ(json["metrics"].size(), 1U);
  EXPECT_EQ(json["metrics"][0]["better"], "lower");
}

TEST_F(ListVerb, SequenceMetricsAreListedWithTheirScope) {
  const auto json = discern_json({"list", "metrics", "--filter", "^fl"}, "list-metrics");
  ASSERT_EQ(json["metrics"].size(), 2U);
  EXPECT_EQ(json["metrics"][0]["name"], "flip");
  EXPECT_EQ(json["metrics"][0]["scope"], "image");
  EXPECT_EQ(json["metrics"][1]["name"], "flicker");
  EXPECT_EQ(json["metrics"][1]["scope"], "sequence");
  const auto text = discern({"list", "metrics", "--filter", "^flicker$"}).stdout_text;
  EXPECT_NE(text.find("flicker  sequence  JND"), std::string::npos) << text;
}

TEST_F(ListVerb, ScenesShowTheirFaceCount) {
  const auto json = discern_json({"list", "scenes", "--filter", "^cornell-box"}, "list-scenes");
  ASSERT_EQ(json["scenes"].size(), 2U);
  EXPECT_EQ(json["scenes"][0]["name"], "cornell-box");
  EXPECT_EQ(json["scenes"][0]["faces"], 32);
  const auto text = discern({"list", "scenes", "--filter", "^cornell-box-spot$"}).stdout_text;
  EXPECT_NE(text.find("cornell-box-spot     18       1"), std::string::npos) << text;
}

TEST_F(ListVerb, SuitesFollowTheirSchema) { discern_json({"list", "suites"}, "list-suites"); }

TEST_F(ListVerb, DevicesAreTheProcessorAndEveryPlatform) {
  const auto json = discern_json({"list", "devices"}, "list-devices");
  EXPECT_EQ(json["devices"][0]["kind"], "cpu");
  EXPECT_GE(json["devices"][0]["cores"].get<int>(), 1);
  std::vector<std::string> platforms;
  for (const auto& device : json["devices"]) {
    if (device["kind"] != "gl") continue;
    platforms.push_back(device["gl_platform"]);
    // Usable, or with the reason why not.
    EXPECT_EQ(device["renderer"].is_null(), !device["reason"].is_null()) << device;
  }
  EXPECT_EQ(platforms, (std::vector<std::string>{"egl-device", "egl-surfaceless", "osmesa"}));
  const std::string text = discern({"list", "devices"}).stdout_text;
  for (const std::string& platform : platforms) {
    EXPECT_NE(text.find(platform), std::string::npos) << text;
  }
}

TEST_F(ListVerb, ASceneThatCannotBeReadIsARowWithItsReason) {
  write_text("scenes/broken.yaml", "schema: 1\nscene: broken\n");
  std::vector<std::pair<std::string, std::string>> variables = environment();
  variables.emplace_back("DISCERN_SCENES", path("scenes"));
  const auto result = base::run_command({tests::kProgram, "list", "scenes", "--json"},
                                        std::chrono::seconds(60), variables);
  EXPECT_EQ(schema_problems("list-scenes", result.stdout_text), "");
  const auto json = nlohmann::json::parse(result.stdout_text);
  ASSERT_EQ(json["scenes"].size(), 1U);
  EXPECT_EQ(json["scenes"][0]["faces"], nullptr);
  EXPECT_NE(json["scenes"][0]["reason"].get<std::string>().find("scene has no camera"),
            std::string::npos);
}

TEST_F(ListVerb, RefusesUnknownKindsAndPatterns) {
  expect_refused({"list", "renderes"},
                 "discern list: unknown list \"renderes\"; did you mean \"renderers\"? known: "
                 "renderers, metrics, scenes, suites, devices");
  const auto result = discern({"list", "metrics", "--filter", "["});
  EXPECT_EQ(result.exit.code, 2);
  EXPECT_EQ(result.stderr_text.find("discern: error: --filter \"[\" is not a regular expression"),
            0U);
}

}  // namespace
}  // namespace tests
