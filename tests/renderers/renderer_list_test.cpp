#include "renderers/renderer_list.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "perception/base/errors.h"
#include "perception/base/names.h"
#include "tests/renderers/scene_builder.h"

namespace renderers {
namespace {

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(RendererList, FindsByNameUpToHyphensAndCase) {
  EXPECT_EQ(find_renderer("path", {}).name, "path");
  EXPECT_EQ(find_renderer("Blank", {}).name, "blank");
}

TEST(RendererList, UnknownNameGivesPlaceAndKnownNames) {
  EXPECT_EQ(message_of([] {
              find_renderer("pth", {"suite.yaml", 14, 9});
            }),
            "suite.yaml:14:9: unknown renderer \"pth\"; did you mean \"path\"? known: blank, path, "
            "instant-radiosity, clustered-visibility, ray-bundles, radiosity, final-gather, "
            "grid-final-gather, surface-final-gather, hemisphere-gather, irradiance-cache, "
            "photon-map, "
            "multires-shadows, nichols-shadows, per-pixel-shadows, grid-shadows, "
            "pcss, light-propagation, area-lights");
}

TEST(RendererList, UnknownPresetListsThoseOfTheRenderer) {
  EXPECT_EQ(message_of([] {
              find_preset(find_renderer("path", {}), "besst", {"s.yaml", 3, 2});
            }),
            "s.yaml:3:2: unknown path preset \"besst\"; did you mean \"best\"? known: paper, best");
  EXPECT_EQ(find_preset(find_renderer("path", {}), "paper", {}).name, "paper");
}

TEST(RendererList, EveryEntryIsComplete) {
  for (const RendererInfo& info : renderer_list()) {
    EXPECT_EQ(info.name, base::kebab_case(info.name));
    EXPECT_FALSE(info.summary.empty());
    EXPECT_FALSE(info.source.empty());
    EXPECT_FALSE(info.possible_claims.empty());
    for (const base::ParameterSpec& spec : info.parameters) {
      EXPECT_EQ(spec.name, base::snake_case(spec.name));
      EXPECT_FALSE(spec.doc.empty()) << spec.name;
    }
    for (const char* preset : {"paper", "best"}) {
      const base::Preset& found = find_preset(info, preset, {});
      const base::Parameters resolved =
          base::resolve_parameters(info.parameters, &found, {}, info.name);
      EXPECT_EQ(resolved.entries().size(), info.parameters.size());
      EXPECT_NE(info.create(resolved, {}), nullptr);
      Claims claims = info.claims(resolved, {});
      claims.geometry_clamp.reset();
      EXPECT_NE(std::ranges::find(info.possible_claims, claims), info.possible_claims.end());
    }
  }
}

TEST(RendererList, NamesTheFeaturesARendererLacks) {
  test::SceneBuilder builder;
  builder.add_point_light({0, 0, 0}, glm::vec3(1.0F));
  builder.set_environment(glm::vec3(1.0F));
  EXPECT_TRUE(unsupported_features(find_renderer("path", {}), builder.scene).empty());
  RendererInfo narrow = find_renderer("path", {});
  narrow.supports = {Feature::point_light};
  EXPECT_EQ(unsupported_features(narrow, builder.scene), std::vector<std::string>{"environment"});
}

}  // namespace
}  // namespace renderers
