#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "renderers/radiosity/radiosity_settings.h"
#include "tests/expect_input_error.h"
#include "tests/renderers/element_hierarchy/hierarchy_fixture.h"
#include "tests/renderers/scene_builder.h"

/// The renderer `radiosity` through its contract, against the path tracer.
namespace renderers::test {
namespace {

using Settings = std::vector<std::string>;

Frame radiosity(const scene::Scene& scene, const Settings& settings, int threads = 0) {
  return render(scene, {.renderer = "radiosity",
                        .settings = settings,
                        .width_px = 24,
                        .height_px = 24,
                        .threads = threads});
}

/// The path tracer's picture of the room, made once.
const Frame& truth_of_room() {
  static const Frame frame =
      render(lit_room().scene,
             {.settings = {"transport=diffuse"}, .width_px = 24, .height_px = 24, .samples = 256});
  return frame;
}

/// Root of the mean of squared differences over the mean of the truth's squares, the truth's own
/// noise taken off by its variance.
double relative_error(const perception::Image& image, const Frame& truth) {
  const perception::Image& variance = aov(truth, "variance");
  double difference = 0.0;
  double size = 0.0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const auto expected = static_cast<double>(truth.radiance.pixels[i]);
    const auto noise = static_cast<double>(variance.pixels[i]);
    difference += std::pow(static_cast<double>(image.pixels[i]) - expected, 2) - noise;
    size += expected * expected - noise;
  }
  return std::sqrt(std::max(0.0, difference) / size);
}

/// Indirect light alone, with its own variance.
const Frame& indirect_truth_of_room() {
  static const Frame frame =
      render(lit_room().scene, {.settings = {"transport=diffuse", "part=indirect"},
                                .width_px = 24,
                                .height_px = 24,
                                .samples = 256});
  return frame;
}

TEST(Radiosity, ComesCloserToThePathTracerWithMoreLinks) {
  const SceneBuilder builder = lit_room();
  const Frame& truth = indirect_truth_of_room();
  std::vector<double> errors;
  for (const char* budget : {"link_budget=100", "link_budget=5000", "link_budget=30000"}) {
    const Frame frame = radiosity(builder.scene, {budget, "part=indirect"});
    errors.push_back(relative_error(frame.radiance, truth));
  }
  EXPECT_LT(errors[1], 0.85 * errors[0]) << errors[0];
  EXPECT_LT(errors[2], 0.8 * errors[1]) << errors[1];
  EXPECT_LT(errors[1], 0.085);
  EXPECT_LT(errors[2], 0.065);
}

/// Direct light from the solution or by samples: the same light, once.
TEST(Radiosity, LightIsCountedOnceWhicheverWayItComes) {
  const SceneBuilder builder = lit_room();
  const Frame& truth = truth_of_room();
  const double direct = mean_of(aov(truth, "direct"));
  for (const char* mode : {"direct=solution", "direct=next_event"}) {
    const Frame frame = radiosity(builder.scene, {mode, "link_budget=8000"});
    EXPECT_NEAR(mean_of(frame.radiance), mean_of(truth.radiance), 0.02 * mean_of(truth.radiance))
        << mode;
    EXPECT_NEAR(mean_of(aov(frame, "direct")), direct, 0.02 * direct) << mode;
  }
  EXPECT_GT(direct, 0.2 * mean_of(truth.radiance));  // twice as much or none would be far outside
}

TEST(Radiosity, ThePapersClustersMayFaceEveryWay) {
  const SceneBuilder builder = lit_room();
  const Frame frame =
      radiosity(builder.scene, {"cluster_kernel=isotropic", "link_budget=8000", "part=indirect"});
  EXPECT_LT(relative_error(frame.radiance, indirect_truth_of_room()), 0.095);
}

TEST(Radiosity, SmoothShadingHasNoStepsWhereFlatShadingDoes) {
  const SceneBuilder builder = lit_room();
  const auto roughness = [&](const char* shading) {
    const Frame frame =
        radiosity(builder.scene, {shading, "link_budget=800", "direct=solution", "part=indirect"});
    double sum = 0.0;  // of second differences along rows: steps have large ones
    for (int y = 0; y < 24; ++y) {
      for (int x = 1; x < 23; ++x) {
        sum += std::fabs(static_cast<double>(frame.radiance.at(x - 1, y) +
                                             frame.radiance.at(x + 1, y) -
                                             2.0F * frame.radiance.at(x, y)));
      }
    }
    return sum;
  };
  EXPECT_LT(roughness("shading=smooth"), 0.8 * roughness("shading=flat"));
}

TEST(Radiosity, DrawsTexturesEnvironmentAndBothSides) {
  SceneBuilder builder;
  scene::Texture checks;
  checks.image = perception::make_rgb_image(2, 2, perception::Encoding::scene_linear);
  checks.image.pixels = {1.0F, 0.8F, 0.6F, 0.2F, 0.3F, 0.4F, 0.2F, 0.3F, 0.4F, 1.0F, 0.8F, 0.6F};
  builder.scene.textures.push_back(checks);
  scene::Material cloth = lambert(glm::vec3(0.8F));
  cloth.albedo_texture = 0;
  scene::Material screen = lambert(glm::vec3(0.1F), glm::vec3(2.0F));
  screen.emission_texture = 0;
  const int floor = builder.add_material(cloth);
  const int lamp = builder.add_material(screen);
  const int sheet = builder.add_material(lambert({0.5F, 0.6F, 0.7F}));
  builder.add_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, floor);
  builder.add_quad({-1, 0, 1}, {2, 0, 0}, {0, 1.5F, 0}, lamp);  // shines along +z, away
  builder.add_quad({-1, 0, -1}, {0, 1.2F, 0}, {0, 0, 2}, sheet);
  builder.add_quad({1, 0, -1}, {0, 1.2F, 0}, {0, 0, 2}, sheet);  // its back looks into the room
  builder.set_environment({0.5F, 0.6F, 0.8F});
  builder.look({0.3F, 1.0F, -2.5F}, {0, 0.3F, 0.5F}, 50.0F);
  const Frame truth =
      render(builder.scene,
             {.settings = {"transport=diffuse"}, .width_px = 24, .height_px = 24, .samples = 256});
  for (const char* direct : {"direct=next_event", "direct=solution"}) {
    const Frame frame = radiosity(builder.scene, {direct, "link_budget=5000"});
    EXPECT_LT(relative_error(frame.radiance, truth), 0.06) << direct;
    EXPECT_NEAR(mean_of(frame.radiance), mean_of(truth.radiance), 0.01 * mean_of(truth.radiance))
        << direct;
  }
}

TEST(Radiosity, SameBytesForEveryNumberOfThreads) {
  const SceneBuilder builder = lit_room();
  const Frame one = radiosity(builder.scene, {"link_budget=2000", "camera_rays=2"}, 1);
  const Frame two = radiosity(builder.scene, {"link_budget=2000", "camera_rays=2"}, 2);
  EXPECT_EQ(one.radiance.pixels, two.radiance.pixels);
}

TEST(Radiosity, CountsWhatItDid) {
  const Frame frame = radiosity(lit_room().scene, {"link_budget=2000", "camera_rays=1"});
  EXPECT_LE(counter(frame, "links"), 2000.0);
  EXPECT_GE(counter(frame, "bytes_per_link"), 24.0);
  EXPECT_GT(counter(frame, "rays"), counter(frame, "solution_rays"));
  EXPECT_EQ(counter(frame, "has_converged"), 1.0);
}

TEST(Radiosity, ADarkSceneIsBlackAndSaysSo) {
  SceneBuilder builder;
  builder.add_quad({-1, -1, 1}, {0, 2, 0}, {2, 0, 0},
                   builder.add_material(lambert(glm::vec3(0.5F))));
  builder.look({0, 0, 0}, {0, 0, 1}, 60.0F);
  const Frame frame = radiosity(builder.scene, {});
  for (const float value : frame.radiance.pixels) EXPECT_EQ(value, 0.0F);
  ASSERT_EQ(frame.notes.size(), 1U);
  EXPECT_EQ(frame.notes.front(), "no light reaches a surface");
}

TEST(RadiositySettings, PaperShowsTheSolutionAndBestSamplesTheLights) {
  const RendererInfo& info = find_renderer("radiosity", {});
  const auto of_preset = [&](const char* name) {
    const base::Preset& preset = find_preset(info, name, {});
    return radiosity::settings_of(
        base::resolve_parameters(info.parameters, &preset, {}, info.name));
  };
  EXPECT_EQ(of_preset("paper").direct, radiosity::DirectMode::solution);
  EXPECT_EQ(of_preset("paper").solver.refinement.links.kernel,
            element_hierarchy::ClusterKernel::isotropic);
  EXPECT_EQ(of_preset("best").direct, radiosity::DirectMode::next_event);
  EXPECT_EQ(of_preset("best").solver.refinement.links.kernel,
            element_hierarchy::ClusterKernel::sampled);
}

TEST(RadiositySettings, RefusesABudgetTooSmallForTheFirstLinks) {
  EXPECT_NE(tests::input_error_of([] { parameters_of("radiosity", {"link_budget=10"}); }),
            "no error");
}

}  // namespace
}  // namespace renderers::test
