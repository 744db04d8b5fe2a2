#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

using RefVerb = ProgramTest;

TEST_F(RefVerb, BuildsExtendsVerifiesAndLists) {
  const std::vector<std::string> scene{"--scene", "cornell-box-spot", "--size", "16x16"};
  const auto with = [&scene](std::vector<std::string> words) {
    words.insert(words.end(), scene.begin(), scene.end());
    return words;
  };
  EXPECT_EQ(discern_json({"ref", "info"}, "ref")["references"].size(), 0U);

  const auto built = discern_json(with({"ref", "build", "--samples", "32"}), "ref");
  ASSERT_EQ(built["references"].size(), 1U);
  EXPECT_EQ(built["references"][0]["samples"], 32);
  const std::filesystem::path stored = built["references"][0]["folder"].get<std::string>();
  EXPECT_TRUE(std::filesystem::exists(stored / "reference.exr"));

  const auto verified = discern_json(with({"ref", "verify"}), "ref");
  EXPECT_EQ(verified["status"], "ok");
  EXPECT_EQ(verified["references"][0]["pixels"], 256);

  const auto extended = discern_json(with({"ref", "extend", "--samples", "32"}), "ref");
  EXPECT_EQ(extended["references"][0]["samples"], 64);

  const auto info = discern_json({"ref", "info"}, "ref");
  ASSERT_EQ(info["references"].size(), 1U);
  EXPECT_EQ(info["references"][0]["hash"], built["references"][0]["hash"]);
  const auto text = discern({"ref", "info"});
  EXPECT_NE(text.stdout_text.find("cornell-box-spot"), std::string::npos);
}

TEST_F(RefVerb, BuildsWhatASuiteNeeds) {
  const std::string suite = write_text("a.yaml", R"(schema: 1
suite: a
viewing: {ppd: 60}
scenes: [{id: box, file: cornell-box-spot, size: [8, 8], reference: {samples: 8}}]
methods:
  - {id: all, renderer: path}
  - {id: one, renderer: path, parameters: {transport: one_bounce}}
budgets: [{samples: 1}]
metrics: [mse]
)");
  const auto built = discern_json({"ref", "build", suite}, "ref");
  EXPECT_EQ(built["references"].size(), 2U);
  const auto plan = discern_json({"check", suite}, "check");
  for (const auto& reference : plan["references"]) EXPECT_EQ(reference["stored"], true);
}

}  // namespace
}  // namespace tests
