#include <algorithm>
#include <regex>

#include "perception/base/document.h"
#include "renderers/scene/scene.h"
#include "suites/command_line/schemas.h"
#include "tests/places.h"
#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

class SchemaVerb : public ProgramTest {
 protected:
  /// Problems of a YAML document by a schema.
  std::string yaml_problems(const std::string& schema, const base::Node& node) const {
    return schema_problems(schema, node.to_json().dump());
  }
};

TEST_F(SchemaVerb, PrintsEverySchemaComplete) {
  for (const auto& embedded : suites::command_line::embedded_schemas()) {
    const auto json = suites::command_line::schema(std::string(embedded.name));
    EXPECT_TRUE(json.contains("$schema")) << embedded.name;
    EXPECT_TRUE(json.contains("title")) << embedded.name;
    EXPECT_EQ(json.dump().find("$include"), std::string::npos) << embedded.name;
  }
}

TEST_F(SchemaVerb, RefusesUnknownNames) {
  const auto result = discern({"schema", "rendr"});
  EXPECT_EQ(result.exit.code, 2);
  EXPECT_EQ(result.stderr_text.find("discern: error: discern schema: unknown schema \"rendr\"; did "
                                    "you mean \"render\"? known: accept, bisect, cell, "),
            0U)
      << result.stderr_text;
}

/// The negative control of every test that uses schema_problems.
TEST_F(SchemaVerb, TheCheckFindsMissingWrongAndUndocumentedFields) {
  const std::string good = R"({"schema":1,"status":"error","reason":"x","exit_code":2})";
  EXPECT_EQ(schema_problems("error", good), "");
  EXPECT_NE(schema_problems("error", R"({"schema":1,"status":"error","exit_code":2})"), "");
  EXPECT_NE(schema_problems("error", std::regex_replace(good, std::regex("\"x\""), "7")), "");
  EXPECT_NE(schema_problems("error", std::regex_replace(good, std::regex("reason"), "cause")), "");
}

TEST_F(SchemaVerb, EveryCatalogueSceneFollowsTheSceneSchema) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::filesystem::path(tests::kSourceFolder) / "suites/scenes")) {
    if (entry.path().extension() != ".yaml") continue;
    EXPECT_EQ(yaml_problems("scene", base::read_document(entry.path())), "") << entry.path();
    ++count;
  }
  EXPECT_GE(count, 6U);
}

TEST_F(SchemaVerb, AMaterialHasALobeOfEitherKind) {
  const auto problems = [&](const std::string& material) {
    const std::string text =
        "schema: 1\nscene: a\ncamera: {position: [0, 0, -3], look_at: [0, 0, 0], "
        "vertical_fov_deg: 40}\nmaterials: {grey: " +
        material + "}\n";
    return yaml_problems("scene", base::parse_document(text, "a.yaml"));
  };
  EXPECT_EQ(problems("{albedo: 0.2, ggx: {albedo: 0.3, alpha: 0.5}}"), "");
  EXPECT_EQ(problems("{albedo: 0.2, phong: {albedo: 0.3, exponent: 5}}"), "");
  EXPECT_EQ(problems("{emission: 2, emission_profile: [1, 0.5, 0]}"), "");
  EXPECT_NE(problems("{emission: 2, emission_profile: [1]}"), "");
  EXPECT_NE(problems("{emission: 2, emission_profile: [1, -1]}"), "");
  EXPECT_NE(problems("{albedo: 0.2, ggx: {albedo: 0.3, exponent: 5}}"), "");
  EXPECT_NE(problems("{albedo: 0.2, ggx: {albedo: 0.3, alpha: 0}}"), "");
}

/// What scenes may need is listed in the schemas of three verbs.
TEST_F(SchemaVerb, SchemasKnowEveryFeatureOfScenes) {
  using renderers::scene::Feature;
  for (const char* name : {"check", "list-renderers", "list-scenes"}) {
    const std::string text = suites::command_line::schema(name).dump();
    for (int i = 0; i <= static_cast<int>(Feature::animation); ++i) {
      const std::string feature = renderers::scene::to_string(static_cast<Feature>(i));
      EXPECT_NE(text.find('"' + feature + '"'), std::string::npos) << name << " " << feature;
    }
  }
}

TEST_F(SchemaVerb, EveryCatalogueSuiteFollowsTheSuiteSchema) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(
           std::filesystem::path(tests::kSourceFolder) / "suites/catalog")) {
    if (entry.path().extension() != ".yaml") continue;
    const base::Node document = base::read_document(entry.path());
    const char* schema = document.find("kind") == nullptr ? "suite" : "psychophysics-suite";
    EXPECT_EQ(yaml_problems(schema, document), "") << entry.path();
  }
}

TEST_F(SchemaVerb, TheInputSchemasRefuseUnknownKeys) {
  const auto sunny = [&](const char* sun) {
    return yaml_problems(
        "scene",
        base::parse_document(
            std::string("schema: 1\nscene: a\nenvironment: {constant: 1, sun: ") + sun + "}\n",
            "a.yaml"));
  };
  EXPECT_NE(sunny("{towards: [0, 1, 0], irradiance: 1, size: 1}").find("size"), std::string::npos);
  const base::Node scene = base::parse_document("schema: 1\nscene: a\nlihgts: []\n", "a.yaml");
  EXPECT_NE(yaml_problems("scene", scene).find("lihgts"), std::string::npos);
  const base::Node suite = base::parse_document(
      "schema: 1\nsuite: a\nviewing: {ppd: 60}\nscenes: [{id: a, file: furnace, sice: [8, 8]}]\n"
      "methods: [{id: p, renderer: path}]\n",
      "a.yaml");
  EXPECT_NE(yaml_problems("suite", suite).find("sice"), std::string::npos);
}

}  // namespace
}  // namespace tests
