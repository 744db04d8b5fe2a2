#include "suites/parameter_grid.h"

#include <gtest/gtest.h>

#include "tests/expect_input_error.h"

namespace {

/// The points of a grid as text: "a=1,b=x | a=2,b=x".
std::string grid_of(const std::string& yaml) {
  const base::Node node = base::parse_document(yaml, "grid.yaml");
  std::string text;
  for (const suites::GridPoint& point : suites::parameter_grid(
           {node.find("matrix"), node.find("zip"), node.find("include"), node.find("exclude")})) {
    if (!text.empty()) text += " | ";
    std::string values;
    for (const auto& [name, value] : point) {
      values += (values.empty() ? "" : ",") + name + "=" + value.scalar_text(name);
    }
    text += values.empty() ? "-" : values;
  }
  return text;
}

std::string error_of(const std::string& yaml) {
  return tests::input_error_of([&] { grid_of(yaml); });
}

TEST(ParameterGrid, WithoutKeysIsOnePoint) { EXPECT_EQ(grid_of("{}"), "-"); }

TEST(ParameterGrid, MatrixIsEveryCombinationLastAxisFastest) {
  EXPECT_EQ(grid_of("matrix: {vals: [2, 5], vpls: [16, 32]}"),
            "vals=2,vpls=16 | vals=2,vpls=32 | vals=5,vpls=16 | vals=5,vpls=32");
}

TEST(ParameterGrid, NamesAreSnakeCase) {
  EXPECT_EQ(grid_of("matrix: {max-depth: [1]}"), "max_depth=1");
}

TEST(ParameterGrid, ZipGoesInLockstepAndIsCrossedWithTheMatrix) {
  EXPECT_EQ(grid_of("{matrix: {a: [1, 2]}, zip: {b: [3, 4], c: [5, 6]}}"),
            "a=1,b=3,c=5 | a=1,b=4,c=6 | a=2,b=3,c=5 | a=2,b=4,c=6");
}

TEST(ParameterGrid, ExcludeRemovesWhatHoldsAllItsValues) {
  EXPECT_EQ(grid_of("{matrix: {a: [1, 2], b: [3, 4]}, exclude: [{a: 1, b: 4}]}"),
            "a=1,b=3 | a=2,b=3 | a=2,b=4");
  EXPECT_EQ(grid_of("{matrix: {a: [1, 2], b: [3, 4]}, exclude: [{a: 1}]}"), "a=2,b=3 | a=2,b=4");
}

// The example of GitHub's documentation of `matrix.include`.
TEST(ParameterGrid, IncludeFollowsGitHubsRule) {
  EXPECT_EQ(grid_of("matrix: {fruit: [apple, pear], animal: [cat, dog]}\n"
                    "include:\n"
                    "  - {color: green}\n"
                    "  - {color: pink, animal: cat}\n"
                    "  - {fruit: apple, shape: circle}\n"
                    "  - {fruit: banana}\n"
                    "  - {fruit: banana, animal: cat}\n"),
            "fruit=apple,animal=cat,color=pink,shape=circle | "
            "fruit=apple,animal=dog,color=green,shape=circle | "
            "fruit=pear,animal=cat,color=pink | fruit=pear,animal=dog,color=green | "
            "fruit=banana | fruit=banana,animal=cat");
}

TEST(ParameterGrid, IncludeAloneIsAListOfPoints) {
  EXPECT_EQ(grid_of("include: [{a: 1}, {a: 2, b: 3}]"), "a=1 | a=2,b=3");
}

TEST(ParameterGrid, IncludeAndExcludeMayStandInsideTheMatrix) {
  EXPECT_EQ(grid_of("matrix: {a: [1, 2], exclude: [{a: 1}], include: [{a: 3}]}"), "a=2 | a=3");
  EXPECT_EQ(error_of("{matrix: {a: [1], include: [{a: 3}]}, include: [{a: 4}]}"),
            "grid.yaml:1:28: include stands beside matrix and inside it; keep one");
}

TEST(ParameterGrid, ErrorsNameThePlace) {
  EXPECT_EQ(error_of("matrix: {a: []}"), "grid.yaml:1:13: a has no values");
  EXPECT_EQ(error_of("zip: {a: [1, 2], b: [3]}"),
            "grid.yaml:1:21: zip needs lists of one length; b has 1, the lists before it have 2");
  EXPECT_EQ(error_of("{matrix: {a: [1]}, zip: {a: [1]}}"),
            "grid.yaml:1:30: a is in matrix and in zip");
  EXPECT_EQ(error_of("{matrix: {a: [1]}, exclude: [{a: 7}]}"),
            "grid.yaml:1:34: this entry of exclude matches no combination of matrix and zip");
  EXPECT_EQ(error_of("{matrix: {a: [1]}, exclude: [{a: 1}]}"),
            "grid.yaml:1:29: exclude removes every combination");
  EXPECT_EQ(error_of("matrix: [1]"),
            "grid.yaml:1:9: matrix must be a map of parameter names to lists; found a list");
}

}  // namespace
