#include <algorithm>
#include <regex>

#include "perception/base/document.h"
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
