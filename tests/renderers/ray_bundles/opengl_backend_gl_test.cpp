#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/renderers/opengl/platform_test.h"
#include "tests/renderers/ray_bundles/bundle_fixture.h"

/// The renderer `ray-bundles` with the crossings of its bundles found by OpenGL.
namespace renderers::test {
namespace {

using Settings = std::vector<std::string>;

/// A room with a glossy block, a checked wall, a lamp and a hole to the sky.
SceneBuilder room() {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.7F)));
  scene::Texture checks;
  checks.image = perception::make_rgb_image(2, 2, perception::Encoding::scene_linear);
  checks.image.pixels = {1.0F, 0.8F, 0.6F, 0.2F, 0.3F, 0.4F, 0.2F, 0.3F, 0.4F, 1.0F, 0.8F, 0.6F};
  builder.scene.textures.push_back(std::move(checks));
  scene::Material checked = lambert(glm::vec3(0.8F));
  checked.albedo_texture = 0;
  const int wall = builder.add_material(checked);
  const int lamp = builder.add_material(lambert(glm::vec3(0.3F), glm::vec3(5.0F)));
  const int steel = builder.add_material(phong(glm::vec3(0.2F), glm::vec3(0.4F), 20.0F));
  builder.add_quad({-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, white);
  builder.add_quad({-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, wall);
  builder.add_quad({-1, -1, -1}, {0, 2, 0}, {0, 0, 2}, white);
  builder.add_quad({1, -1, -1}, {0, 0, 2}, {0, 2, 0}, white);
  builder.add_quad({-0.4F, 0.95F, -0.4F}, {0.8F, 0, 0}, {0, 0, 0.8F}, lamp);
  builder.add_box({0.0F, -0.9F, 0.1F}, {0.5F, -0.3F, 0.6F}, steel, false);
  builder.set_environment({0.3F, 0.4F, 0.6F});
  builder.look({0.1F, 0.0F, -2.4F}, {0, -0.1F, 1}, 60.0F);
  return builder;
}

Frame bundles(const scene::Scene& scene, Settings settings, const char* backend) {
  settings.push_back(std::string("backend=") + backend);
  settings.insert(settings.begin(), {"atlas_side=96", "lines=128", "pass_directions=64"});
  return render(scene, {.renderer = "ray-bundles",
                        .settings = std::move(settings),
                        .width_px = 40,
                        .height_px = 40,
                        .samples = 128});
}

/// sqrt of the mean square difference over that of the values.
double relative_difference(const perception::Image& a, const perception::Image& b) {
  double square = 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const auto value = static_cast<double>(a.pixels[i]);
    const double difference = value - static_cast<double>(b.pixels[i]);
    square += difference * difference;
    sum += value * value;
  }
  return std::sqrt(square / sum);
}

/// Both backends cast the same lines, but for edges: one in 10,000 lines differs.
TEST(OpenGlBackend, MakesTheCpusPicturesInEveryMode) {
  const SceneBuilder builder = room();
  const Settings modes[] = {{},
                            {"transfer=gather"},
                            {"lists=fixed_k"},
                            {"lists=fixed_k", "slots=2", "slot_passes=one"},
                            {"lists=trace"},
                            {"lists=trace", "transfer=gather", "direct=bundles"},
                            {"feed=running_mean", "normalisation=uniform"},
                            {"direct=bundles", "importance=0.5"},
                            {"feed=jacobi", "bounces=3"},
                            {"feed=stochastic", "textures=texel"},
                            {"glossy=chain", "final_glossy=bundles"}};
  for (const Settings& mode : modes) {
    const std::string name = mode.empty() ? "default" : mode.front() + " " + mode.back();
    const Frame cpu = bundles(builder.scene, mode, "cpu");
    const Frame gpu = bundles(builder.scene, mode, "opengl");
    EXPECT_LT(relative_difference(cpu.radiance, gpu.radiance), 2e-3) << name;
    EXPECT_LT(relative_difference(aov(cpu, "indirect"), aov(gpu, "indirect")), 4e-3) << name;
    EXPECT_EQ(counter(cpu, "lines"), counter(gpu, "lines"));
    EXPECT_NEAR(counter(gpu, "fragments") / counter(cpu, "fragments"), 1.0, 1e-4) << name;
    EXPECT_NEAR(counter(gpu, "overflow"), counter(cpu, "overflow"),
                1e-3 * counter(cpu, "overflow"));
    EXPECT_EQ(cpu.device, "cpu");
    EXPECT_NE(gpu.device, "cpu");
    EXPECT_FALSE(gpu.gl_platform.empty());
  }
  // What the tolerance has to tell apart: other directions, another mean.
  const Frame cpu = bundles(builder.scene, {}, "cpu");
  const Frame other = bundles(builder.scene, {"directions=halton"}, "opengl");
  EXPECT_GT(relative_difference(aov(cpu, "indirect"), aov(other, "indirect")), 8e-3);
}

TEST(OpenGlBackend, ExchangesOnTheDevice) {
  const SceneBuilder builder = room();
  for (const char* lists : {"lists=raster", "lists=trace"}) {
    const Settings mode{"textures=texel", "direct=bundles", lists};
    Settings on_device = mode;
    on_device.push_back("exchange=device");
    const Frame cpu = bundles(builder.scene, mode, "cpu");
    const Frame gpu = bundles(builder.scene, on_device, "opengl");
    EXPECT_LT(relative_difference(cpu.radiance, gpu.radiance), 2e-3) << lists;
    EXPECT_LT(relative_difference(aov(cpu, "indirect"), aov(gpu, "indirect")), 4e-3) << lists;
    for (const char* name : {"receivers", "pairs", "lit_pairs"}) {
      EXPECT_NEAR(counter(gpu, name) / counter(cpu, name), 1.0, 2e-3) << name << " " << lists;
    }
  }
}

/// Checkpoints look at the solution between directions.
TEST(OpenGlBackend, CheckpointsOfTheDeviceChangeNothing) {
  const SceneBuilder builder = room();
  RenderRequest request{.renderer = "ray-bundles",
                        .settings = {"atlas_side=96", "lines=96", "textures=texel",
                                     "backend=opengl", "exchange=device"},
                        .samples = 20};
  const Frame whole = render(builder.scene, request);
  std::vector<double> means;
  request.change_job = [&](RenderJob& job) {
    job.checkpoint = [&](const perception::Image& image, std::int64_t) {
      means.push_back(mean_of(image));
    };
  };
  EXPECT_EQ(render(builder.scene, request).radiance.pixels, whole.radiance.pixels);
  ASSERT_GE(means.size(), 3U);
  EXPECT_NEAR(means.back(), mean_of(whole.radiance), 0.2 * mean_of(whole.radiance));
}

/// Threads of the CPU's stages; a software driver keeps those that it began with.
TEST(OpenGlBackend, IsTheSameForAnyThreadsOfTheCpusStages) {
  const SceneBuilder builder = room();
  RenderRequest request{.renderer = "ray-bundles",
                        .settings = {"atlas_side=96", "lines=128", "backend=opengl"},
                        .samples = 16};
  const Frame first = render(builder.scene, request);
  request.threads = 1;
  EXPECT_EQ(render(builder.scene, request).radiance.pixels, first.radiance.pixels);
}

/// Radiance 1 + albedo J of every texel: 1 / (1 - albedo).
TEST(OpenGlBackend, FurnaceIsTheGeometricSeries) {
  const auto context = opengl::Context::create("auto");
  constexpr double kAlbedo = 0.8;
  SceneBuilder builder;
  const int wall =
      builder.add_material(lambert(glm::vec3(static_cast<float>(kAlbedo)), glm::vec3(1.0F)));
  builder.add_box(glm::vec3(-1.0F), {1.0F, 0.8F, 1.4F}, wall, true);
  for (const auto lists : {ray_bundles::ListKind::raster, ray_bundles::ListKind::fixed_k,
                           ray_bundles::ListKind::trace}) {
    BundleScene built(builder.scene, 32);
    ray_bundles::TransportSettings settings;
    settings.device = context;
    settings.lists = lists;
    settings.lines_across = 48;
    const ray_bundles::BundleTransport transport = transported(built, settings, 1000);
    const LightStatistics light = light_on(built, transport.solution(), LightOf::both);
    const double expected = 1.0 / (1.0 - kAlbedo);
    EXPECT_NEAR(1.0 + kAlbedo * light.mean.x, expected, 5e-3 * expected);
    EXPECT_NEAR(1.0 + kAlbedo * light.least, expected, 1e-2 * expected);
    EXPECT_NEAR(1.0 + kAlbedo * light.greatest, expected, 1e-2 * expected);
    EXPECT_EQ(transport.counts().dropped, 0U);
  }
}

/// A closed block in a lit room is dark inside: beside its edges the device's rounding of corners
/// must not change the order of its faces.
TEST(OpenGlBackend, BodiesDoNotLeak) {
  const auto context = opengl::Context::create("auto");
  SceneBuilder builder;
  const int wall = builder.add_material(lambert(glm::vec3(0.7F)));
  const int lamp = builder.add_material(lambert(glm::vec3(0.3F), glm::vec3(5.0F)));
  builder.add_box({-1.0F, -1.0F, -3.0F}, glm::vec3(1.0F), wall, true);
  builder.add_quad({-0.4F, 0.95F, -0.4F}, {0.8F, 0, 0}, {0, 0, 0.8F}, lamp);
  const int block = add_closed_box(builder, {0.0F, -0.9F, 0.1F}, {0.5F, -0.3F, 0.6F}, wall, false);
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    BundleScene built(builder.scene, 96);
    ray_bundles::TransportSettings settings;
    if (seed % 2 == 0) settings.lists = ray_bundles::ListKind::trace;
    settings.device = context;
    settings.lines_across = 128;
    settings.seed = seed;
    const ray_bundles::BundleTransport transport = transported(built, settings, 200);
    const auto of = [&](texel_atlas::Side side) {
      return light_on(built, transport.solution(), LightOf::both, block, side);
    };
    EXPECT_GT(of(texel_atlas::Side::front).mean.x, 0.1);
    EXPECT_EQ(of(texel_atlas::Side::back).greatest, 0.0) << seed;
  }
}

bool has_hardware() {
  try {
    opengl::Context::create("egl-device");
    return true;
  } catch (const UnsupportedError&) {
    return false;
  }
}

TEST(OpenGlBackend, AutoTakesHardwareAlone) {
  const SceneBuilder builder = room();
  EXPECT_EQ(bundles(builder.scene, {}, "auto").device != "cpu", has_hardware());
  EXPECT_EQ(bundles(builder.scene, {"lists=trace"}, "auto").device != "cpu", has_hardware());
}

/// The message of `prepare` where there is no hardware.
std::string refusal_of(const char* setting) {
  const SceneBuilder builder = room();
  Devices devices;
  devices.platform = "egl-device";
  const auto renderer =
      find_renderer("ray-bundles", {}).create(parameters_of("ray-bundles", {setting}), devices);
  StageTimer timer;
  try {
    renderer->prepare(builder.scene, timer);
  } catch (const UnsupportedError& error) {
    return error.what();
  }
  return "no error";
}

TEST(OpenGlBackend, SaysThatThereIsNoDevice) {
  if (has_hardware()) GTEST_SKIP() << "there is one";
  EXPECT_TRUE(refusal_of("backend=opengl").starts_with("no OpenGL 4.5 core: egl-device"))
      << refusal_of("backend=opengl");
  EXPECT_EQ(refusal_of("exchange=device"),
            "ray-bundles: exchange device, but backend auto finds no hardware and draws on the "
            "CPU; accepted: backend opengl, or exchange auto or cpu");
  EXPECT_EQ(refusal_of("backend=auto"), "no error");
}

}  // namespace
}  // namespace renderers::test
