#include "renderers/scene/object_reader.h"

#include "tests/expect_input_error.h"
#include "tests/renderers/scene/scene_text.h"

#include <gtest/gtest.h>

namespace renderers::scene {
namespace {

std::string town(const std::string& more) {
  return tests::kSmallScene +
         "  - {name: town, generator: {name: scattered-boxes, count: 2, area: [4, 4], height: "
         "[0.5, 1]}" +
         more + "}\n";
}

std::string material_of_town(const std::string& more) {
  const Scene scene = tests::parse(town(more)).at_frame(0);
  return scene.materials[static_cast<std::size_t>(scene.objects[1].material)].name;
}

TEST(GeneratedParts, HaveTheirOwnMaterialOrTheOneNamedForThem) {
  EXPECT_EQ(material_of_town(""), "town.boxes");
  EXPECT_EQ(material_of_town(", materials: {boxes: grey}"), "grey");
  EXPECT_EQ(material_of_town(", material: grey"), "grey");
  EXPECT_EQ(material_of_town(", materials: {}"), "town.boxes");
}

TEST(GeneratedParts, UnknownPartsAndMaterialsAreRefused) {
  const auto error_of = [](const std::string& more) {
    return tests::input_error_of([&] { tests::parse(town(more)); });
  };
  EXPECT_EQ(error_of(", materials: {boxs: grey}"),
            "small.yaml:7:108: unknown part \"boxs\"; did you mean \"boxes\"? known: boxes");
  EXPECT_EQ(error_of(", materials: {boxes: gray}"),
            "small.yaml:7:115: unknown material \"gray\"; did you mean \"grey\"? known: grey");
  EXPECT_EQ(error_of(", materials: grey"),
            "small.yaml:7:107: materials must be a map {part: material}");
}

TEST(GeneratedParts, OtherShapesHaveOneMaterial) {
  const std::string text = tests::with(tests::kSmallScene, "material: grey}",
                                       "material: grey, materials: {plate: grey}}");
  EXPECT_NE(tests::input_error_of([&] { tests::parse(text); }).find("unknown key \"materials\""),
            std::string::npos);
}

}  // namespace
}  // namespace renderers::scene
