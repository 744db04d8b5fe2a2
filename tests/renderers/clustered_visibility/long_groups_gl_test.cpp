// Lights of long groups ask for their visibility ahead: the same light, to the last bit.
#include <algorithm>
#include <string>
#include <vector>

#include "renderers/clustered_visibility/clustered_lights.h"
#include "renderers/opengl/view.h"
#include "tests/renderers/clustered_visibility/light_bench.h"
#include "tests/renderers/instant_radiosity/box_scenes.h"
#include "tests/renderers/many_lights/gl_fixture.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::clustered_visibility {
namespace {

constexpr int kSide_px = 24;
constexpr int kLights = 256;

class LongGroups : public test::GlTest {};

TEST_F(LongGroups, GiveTheLightOfShortOnesToTheLastBit) {
  const scene::Scene scene = test::glossy_box();
  StageTimer timer;
  opengl::GpuScene gpu_scene(context());
  gpu_scene.load(scene, timer);
  opengl::GeometryBuffer surfaces(context(), kSide_px, kSide_px);
  surfaces.render(gpu_scene, opengl::camera_view(scene.camera, kSide_px, kSide_px));
  auto set = test_clustered_visibility::box_lights(kLights);
  test_clustered_visibility::darken(set, 5, 2);
  const opengl::Buffer lights = test_clustered_visibility::buffer_of(context(), set);

  many_lights::GatherSettings gather_settings;
  gather_settings.interleave = 1;
  gather_settings.geometry_clamp = 10.0F;
  gather_settings.with_glossy = true;
  gather_settings.camera_position = scene.camera.position;
  for (const char* visibility :
       {"visibility=hard", "visibility=pcf", "visibility=cssm", "visibility=msm"}) {
    const Settings settings = settings_of(test::parameters_of(
        "clustered-visibility",
        {visibility, "vpls=256", "vals=8", "shadow_map_px=32", "interleave=1"}));
    ClusteredLights clustered(context(), settings);
    clustered.load(scene, timer);
    clustered.make(lights, gpu_scene, 0, timer);
    const AreaShadows shadows = clustered.shadows();
    const int most = most_lights_at_once(settings.area, shadows.filtered).value_or(kLights);
    const auto gathered = [&](bool is_long) {
      many_lights::GatherVisibility seen = gather_visibility(settings.area, shadows);
      if (is_long) seen.defines.emplace_back("WITH_LONG_GROUPS", "1");
      many_lights::Gather gather(context());
      gather.begin(surfaces, gather_settings);
      for (int first = 0; first < kLights; first += most) {
        gather.add(surfaces, gpu_scene,
                   {.lights = &clustered.clusters().sorted(),
                    .count = kLights,
                    .first = first,
                    .batch = std::min(most, kLights - first),
                    .visibility = &seen},
                   gather_settings);
      }
      std::vector<float> light = gather.targets().irradiance.read();
      const std::vector<float> glossy = gather.targets().glossy.read();
      EXPECT_GT(*std::ranges::max_element(glossy), 0.0F);
      light.insert(light.end(), glossy.begin(), glossy.end());
      return light;
    };
    const std::vector<float> as_short = gathered(false);
    EXPECT_GT(*std::ranges::max_element(as_short), 0.0F);
    EXPECT_EQ(gathered(true), as_short) << visibility;
    many_lights::Gather chosen(context());
    chosen.begin(surfaces, gather_settings);
    clustered.gather(surfaces, gpu_scene, gather_settings, chosen);
    const std::vector<float> irradiance = chosen.targets().irradiance.read();
    EXPECT_TRUE(std::ranges::equal(
        irradiance,
        std::vector<float>(as_short.begin(),
                           as_short.begin() + static_cast<std::ptrdiff_t>(irradiance.size()))));
  }
}

}  // namespace
}  // namespace renderers::clustered_visibility
