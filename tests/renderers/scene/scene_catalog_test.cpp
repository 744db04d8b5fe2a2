#include "renderers/scene/scene_file.h"
#include "tests/expect_input_error.h"
#include "tests/places.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace renderers::scene {
namespace {

const std::filesystem::path kCatalog =
    std::filesystem::path(tests::kSourceFolder) / "suites/scenes";

const std::map<std::string, std::size_t> kFaces{{"atrium", 97541},
                                                {"common-box", 38},
                                                {"cornell-box", 32},
                                                {"cornell-box-spot", 18},
                                                {"cornell-bunny", 12 + 69666},
                                                {"cornell-horse", 12 + 7172},
                                                {"cornell-horse-17k", 17000},
                                                {"corner-spot", 12 + 2208 + 22},
                                                {"dragons", 49959 + 2 + 3 * 7172 + 2 * 14348},
                                                {"furnace", 12},
                                                {"l-wall", 32},
                                                {"library", 500000},
                                                {"masking-floor", 5990},
                                                {"penumbra-fence", 56},
                                                {"penumbra-plane", 6},
                                                {"soft-and-crisp", 8},
                                                {"textured-room", 12 + 12 + 9024},
                                                {"thin-occluder", 6},
                                                {"toy-room", 250000}};

/// Lambert surfaces and one spot: what reflective shadow maps begin with.
const std::set<std::string> kLitBySpots{
    "atrium", "cornell-box-spot", "cornell-horse-17k", "corner-spot",    "dragons",
    "l-wall", "metaballs",        "penumbra-plane",    "soft-and-crisp", "thin-occluder"};

std::vector<std::string> catalog_names() {
  std::vector<std::string> names;
  for (const CatalogEntry& entry : list_scene_files(kCatalog)) names.push_back(entry.name);
  return names;
}

TEST(Catalog, HoldsTheScenesThatAreCheckedByName) {
  const std::vector<std::string> names = catalog_names();
  const auto expect_there = [&](const std::string& name) {
    EXPECT_NE(std::ranges::find(names, name), names.end()) << name;
  };
  for (const auto& [name, count] : kFaces) expect_there(name);
  for (const std::string& name : kLitBySpots) expect_there(name);
}

class EveryScene : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(OfTheCatalog, EveryScene, testing::ValuesIn(catalog_names()),
                         [](const auto& scene) {
                           std::string name = scene.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

TEST_P(EveryScene, LoadsWithItsFaces) {
  const std::string name = GetParam();
  const SceneFile file = read_scene_file(kCatalog / (name + ".yaml"));
  EXPECT_EQ(file.name(), name);
  EXPECT_FALSE(file.summary().empty());
  EXPECT_TRUE(file.warnings().empty()) << file.warnings()[0];
  const Scene last = file.at_frame(file.frame_count() - 1);
  EXPECT_EQ(last.is_animated, file.frame_count() > 1);
  EXPECT_EQ(last.hash, file.at_frame(file.frame_count()).hash);
  const auto known = kFaces.find(name);
  EXPECT_EQ(last.face_count(), known == kFaces.end() ? last.face_count() : known->second);
  if (!kLitBySpots.contains(name)) return;
  EXPECT_EQ(last.lights.size(), 1U);
  for (const Feature feature : features_of(last)) {
    EXPECT_TRUE(feature == Feature::spot_light || feature == Feature::texture ||
                feature == Feature::animation)
        << to_string(feature);
  }
}

TEST(Catalog, CornellBoxShowsRedOnTheLeft) {
  const Scene scene = read_scene_file(kCatalog / "cornell-box.yaml").at_frame(0);
  const glm::vec3 left = camera_ray_direction(scene.camera, 100, 100, 0.0F, 50.0F);
  for (const Object& object : scene.objects) {
    if (object.name != "left-wall") continue;
    EXPECT_GT(left.x * (object.mesh->positions[0].x - scene.camera.position.x), 0.0F);
    const glm::vec3 albedo = scene.materials[static_cast<std::size_t>(object.material)].albedo;
    EXPECT_GT(albedo.x, 5.0F * albedo.y);
  }
}

TEST(Catalog, LampsShineDown) {
  for (const char* name : {"cornell-box", "cornell-horse", "cornell-bunny", "textured-room"}) {
    const Scene scene = read_scene_file(kCatalog / (std::string(name) + ".yaml")).at_frame(0);
    for (const Object& object : scene.objects) {
      if (object.name != "lamp") continue;
      for (const auto& t : object.mesh->triangles) {
        const auto& p = object.mesh->positions;
        EXPECT_LT(glm::cross(p[t.y] - p[t.x], p[t.z] - p[t.x]).y, 0.0F) << name;
      }
    }
  }
}

TEST(Catalog, FurnaceRadianceIsOne) {
  const Scene scene = read_scene_file(kCatalog / "furnace.yaml").at_frame(0);
  const Material& wall = scene.materials[0];
  EXPECT_EQ(wall.emission / (glm::vec3(1.0F) - wall.albedo), glm::vec3(1.0F));
}

TEST(Format, ReadsAllPartsTogether) {
  const std::string text = R"(schema: 1
scene: example
luminance_scale_cd_m2: 100
include: cornell-box.yaml
camera: {position: [2.78, 2.73, -8.0], look_at: [2.78, 2.73, 2.8], up: [0, 1, 0], vertical_fov_deg: 38}
materials: {white: {albedo: [0.75, 0.75, 0.75]}, lacquer: {albedo: [0.2, 0.1, 0.1], phong: {albedo: 0.3, exponent: 40}}, lamp: {emission: [15, 15, 15]}}
objects:
  - {name: horse, mesh: {file: horse.3ds, package: glmark2-data}, material: white, transform: {translate: [2.8, 1, 2.8], rotate_deg: [0, 30, 0], scale: 1.5},
     animation: {keys: [{frame: 0, translate: [2.8, 1, 2.8]}, {frame: 60, translate: [3.8, 1, 2.8]}]}}
lights: [{name: key, type: spot, position: [2.8, 5, 2.8], direction: [0, -1, 0], intensity: [80, 80, 80], cone_deg: [30, 35]}]
)";
  const SceneFile file = parse_scene(base::parse_document(text, "example.yaml"), kCatalog);
  const Scene scene = file.at_frame(30);
  EXPECT_EQ(file.frame_count(), 61);
  EXPECT_EQ(scene.face_count(), 32U + 7172U);
  EXPECT_EQ(scene.objects.back().to_world[3], glm::vec4(3.3F, 1.0F, 2.8F, 1.0F));
  EXPECT_EQ(features_of(scene),
            (std::vector{Feature::spot_light, Feature::area_light, Feature::animation}))
      << "no object is lacquered";
}

TEST(FindScene, ByNameAndByPath) {
  EXPECT_EQ(find_scene_file("cornell_box", kCatalog, ".", {}), kCatalog / "cornell-box.yaml");
  EXPECT_EQ(find_scene_file("scenes/furnace.yaml", kCatalog, kCatalog.parent_path(), {}),
            kCatalog / "furnace.yaml");
  EXPECT_EQ(tests::input_error_of([] {
              find_scene_file("gone.yaml", kCatalog, "/nowhere", {"s.yaml", 3, 4});
            }),
            "s.yaml:3:4: scene file gone.yaml not found (looked for /nowhere/gone.yaml)");
  EXPECT_NE(tests::input_error_of([] {
              find_scene_file("cornel-box", kCatalog, ".", {});
            }).find("did you mean \"cornell-box\"?"),
            std::string::npos);
}

}  // namespace
}  // namespace renderers::scene
