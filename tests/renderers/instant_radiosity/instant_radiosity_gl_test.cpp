#include "renderers/instant_radiosity/instant_radiosity_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "renderers/opengl/context.h"
#include "tests/expect_error.h"
#include "tests/renderers/instant_radiosity/box_scenes.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::test {
namespace {

RenderRequest request_with(std::vector<std::string> settings, int width_px = 20,
                           int height_px = 20) {
  RenderRequest request;
  request.renderer = "instant-radiosity";
  request.settings = std::move(settings);
  request.width_px = width_px;
  request.height_px = height_px;
  request.samples = 0;  // the parameter's
  return request;
}

bool is_finite(const Frame& frame) {
  return std::ranges::all_of(frame.radiance.pixels, [](float v) { return std::isfinite(v); });
}

TEST(InstantRadiosity, TheWholeIsTheDirectAndTheIndirectPart) {
  const scene::Scene scene = boxes_by_light()[2].second;
  const Frame all = render(scene, request_with({"vpls=128"}));
  const Frame indirect = render(scene, request_with({"vpls=128", "part=indirect"}));
  const std::vector<float>& direct = aov(all, "direct").pixels;
  for (std::size_t i = 0; i < direct.size(); ++i) {
    EXPECT_NEAR(all.radiance.pixels[i], direct[i] + indirect.radiance.pixels[i],
                1e-6F * (1.0F + all.radiance.pixels[i]));
  }
  EXPECT_EQ(aov(all, "indirect").pixels, indirect.radiance.pixels);
}

TEST(InstantRadiosity, EveryVisibilityGivesTheSameBytesAgainAndOnAnyNumberOfThreads) {
  const scene::Scene scene = boxes_by_light()[2].second;
  for (const char* visibility : {"none", "shadow_map", "ray", "imperfect"}) {
    RenderRequest request = request_with({"vpls=128", "shadow_map_px=32", "compensation_rays=2",
                                          std::string("visibility=") + visibility});
    const Frame once = render(scene, request);
    request.threads = 1;
    const Frame again = render(scene, request);
    EXPECT_EQ(once.radiance.pixels, again.radiance.pixels) << visibility;
    EXPECT_TRUE(is_finite(once)) << visibility;
  }
}

TEST(InstantRadiosity, TheDriverHasNothingToComplainOf) {
  const scene::Scene scene = glossy_box();
  const RendererInfo& info = find_renderer("instant-radiosity", {});
  Devices devices;
  devices.warm = std::make_shared<WarmStore>();
  for (const char* visibility : {"none", "shadow_map", "ray", "imperfect"}) {
    const auto renderer =
        info.create(parameters_of("instant-radiosity", {"vpls=128", "shadow_map_px=32", "samples=2",
                                                        std::string("visibility=") + visibility}),
                    devices);
    StageTimer timer;
    renderer->prepare(scene, timer);
    RenderJob job;
    job.width_px = job.height_px = 16;
    job.camera = scene.camera;
    renderer->render(job, timer);
    EXPECT_EQ(opengl::Context::of(devices)->take_messages(), std::vector<std::string>{})
        << visibility;
  }
}

TEST(InstantRadiosity, BatchesOfMapsDoNotChangeThePicture) {
  const scene::Scene scene = spot_in_box();
  const auto picture = [&](const char* batch, const char* interleave) {
    return render(scene, request_with({"vpls=100", "visibility=shadow_map", "shadow_map_px=32",
                                       "part=indirect", batch, interleave}))
        .radiance.pixels;
  };
  for (const char* interleave : {"interleave=1", "interleave=4"}) {
    const std::vector<float> whole = picture("shadow_map_batch=100", interleave);
    const std::vector<float> parts = picture("shadow_map_batch=7", interleave);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      EXPECT_NEAR(parts[i], whole[i], 1e-5F * (1e-3F + whole[i]));
    }
  }
}

TEST(InstantRadiosity, AFrameOfASequenceIsThatOfAColdStart) {
  std::vector<scene::Scene> frames{spot_in_box(), boxes_by_light()[0].second, glossy_box()};
  const RenderRequest request =
      request_with({"vpls=128", "visibility=shadow_map", "shadow_map_px=32", "interleave=4"});
  const RendererInfo& info = find_renderer("instant-radiosity", {});
  const auto kept = info.create(parameters_of("instant-radiosity", request.settings), {});
  StageTimer timer;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    timer.set_phase(i == 0 ? Phase::prepare : Phase::update);
    if (i == 0) {
      kept->prepare(frames[i], timer);
    } else {
      kept->update(frames[i], timer);
    }
    timer.set_phase(Phase::render);
    RenderJob job;
    job.width_px = request.width_px;
    job.height_px = request.height_px;
    job.camera = frames[i].camera;
    EXPECT_EQ(kept->render(job, timer).radiance.pixels, render(frames[i], request).radiance.pixels)
        << "frame " << i;
  }
  EXPECT_GT(timer.wall_of("scene_update"), 0.0);
}

TEST(InstantRadiosity, AnotherCameraOrSizeNeedsNoNewStart) {
  const scene::Scene scene = spot_in_box();
  const RenderRequest request = request_with({"vpls=128", "samples=3"}, 21, 13);
  const RendererInfo& info = find_renderer("instant-radiosity", {});
  const auto kept = info.create(parameters_of("instant-radiosity", request.settings), {});
  StageTimer timer;
  kept->prepare(scene, timer);
  RenderJob job;
  job.camera = scene.camera;
  job.camera.position.x -= 0.4F;
  job.width_px = job.height_px = 9;
  kept->render(job, timer);
  job.camera = scene.camera;
  job.width_px = request.width_px;
  job.height_px = request.height_px;
  EXPECT_EQ(kept->render(job, timer).radiance.pixels, render(scene, request).radiance.pixels);
}

TEST(InstantRadiosity, StagesMakeUpTheWholeTime) {
  const scene::Scene scene = boxes_by_light()[2].second;
  for (const char* visibility : {"none", "shadow_map", "ray"}) {
    RenderRequest request = request_with({"vpls=256", "shadow_map_px=32", "compensation_rays=1",
                                          std::string("visibility=") + visibility},
                                         160, 160);
    request.change_job = [](RenderJob& job) { job.samples = 2; };
    render(scene, request);  // compiles
    StageTimer timer;
    const double start_s = steady_seconds();
    render(scene, request, &timer);
    const double total_s = steady_seconds() - start_s;
    const double stages_s = timer.top_level_s(Phase::prepare) + timer.top_level_s(Phase::render);
    // The context is made anew without a store of warm things: its time is no stage of a picture.
    EXPECT_GT(stages_s, 0.5 * total_s) << visibility;
    EXPECT_LE(stages_s, total_s) << visibility;
    EXPECT_GT(timer.wall_of("gather"), 0.0);
    EXPECT_GT(timer.wall_of("visibility"), 0.0);
    EXPECT_GT(timer.wall_of("transport/direct"), 0.0);
    EXPECT_EQ(timer.wall_of("shadow") > 0.0, std::string(visibility) == "shadow_map");
  }
}

TEST(InstantRadiosity, ABackgroundIsTheEnvironmentAndReceivesNothing) {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad({-1.0F, 0.0F, -1.0F}, {0.0F, 0.0F, 2.0F}, {2.0F, 0.0F, 0.0F}, white);
  builder.set_environment({0.25F, 0.5F, 1.0F});
  builder.look({0.0F, 1.0F, 3.0F}, {0.0F, 1.0F, 0.0F}, 60.0F);
  const Frame frame = render(builder.scene, request_with({"vpls=64", "camera_rays=1"}, 17, 9));
  EXPECT_FLOAT_EQ(frame.radiance.pixels[0], 0.25F);
  EXPECT_FLOAT_EQ(frame.radiance.pixels[1], 0.5F);
  EXPECT_FLOAT_EQ(frame.radiance.pixels[2], 1.0F);
  const std::vector<float>& indirect = aov(frame, "indirect").pixels;
  // A plane alone lights nothing, whatever lights it.
  EXPECT_EQ(*std::ranges::max_element(indirect), 0.0F);
}

TEST(InstantRadiosity, PicturesNeedNotBeMultiplesOfTheInterleave) {
  const scene::Scene scene = spot_in_box();
  for (const auto& [width_px, height_px] : {std::pair{1, 1}, {7, 5}, {13, 9}, {8, 17}}) {
    const Frame frame = render(scene, request_with({"vpls=64"}, width_px, height_px));
    EXPECT_TRUE(is_finite(frame));
    EXPECT_GT(mean_radiance(frame), 0.0);
  }
}

TEST(InstantRadiosity, WithoutLightThePictureIsBlackAndSaysSo) {
  scene::Scene scene = spot_in_box();
  scene.lights.clear();
  for (const char* visibility : {"none", "shadow_map", "ray", "imperfect"}) {
    const Frame frame =
        render(scene, request_with({"vpls=64", std::string("visibility=") + visibility}));
    EXPECT_EQ(*std::ranges::max_element(frame.radiance.pixels), 0.0F) << visibility;
    ASSERT_FALSE(frame.notes.empty());
    EXPECT_EQ(frame.notes.front(), "no light reaches a surface: no indirect light");
  }
}

TEST(InstantRadiosity, ALightInsideABlockLightsNothingOutside) {
  scene::Scene scene = spot_in_box();
  scene.lights.front().position = {-0.2F, 0.4F, 0.75F};
  const Frame frame = render(scene, request_with({"vpls=256"}));
  EXPECT_TRUE(is_finite(frame));
  EXPECT_LT(*std::ranges::max_element(frame.radiance.pixels), 1e-4F);
}

TEST(InstantRadiosity, MoreSetsAverageAndStopAtTheBudget) {
  const scene::Scene scene = spot_in_box();
  RenderRequest request = request_with({"vpls=64", "part=indirect", "interleave=1"});
  const Frame truth = render(scene, request_with({"vpls=8192", "part=indirect", "interleave=1"}));
  request.samples = 1;
  const double one = relative_rms(render(scene, request), truth);
  request.samples = 16;
  const Frame many = render(scene, request);
  EXPECT_LT(relative_rms(many, truth), 0.7 * one);
  EXPECT_EQ(many.samples, 16);
  request.samples = 0;
  request.change_job = [](RenderJob& job) { job.time_budget_s = 0.0; };
  EXPECT_EQ(render(scene, request).samples, 1);
}

TEST(InstantRadiosity, CheckpointsArePicturesOfFewerSets) {
  const scene::Scene scene = spot_in_box();
  RenderRequest request = request_with({"vpls=64"});
  std::vector<std::pair<std::int64_t, std::vector<float>>> seen;
  request.samples = 4;
  request.change_job = [&](RenderJob& job) {
    job.checkpoint = [&](const perception::Image& image, std::int64_t samples) {
      seen.emplace_back(samples, image.pixels);
    };
  };
  render(scene, request);
  ASSERT_EQ(seen.size(), 3U);
  request.change_job = nullptr;
  request.samples = 2;
  EXPECT_EQ(seen[1].first, 2);
  EXPECT_EQ(seen[1].second, render(scene, request).radiance.pixels);
}

TEST(InstantRadiosity, SizesBeyondTheDeviceAreUnsupportedOrRefused) {
  const scene::Scene scene = spot_in_box();
  EXPECT_THROW(render(scene, request_with({"vpls=16"}, 65536, 1)), UnsupportedError);
  // Each number is within the limits; all together do not fit into any memory.
  tests::expect_error_with<DeviceMemoryError>(
      [&] {
        render(scene, request_with({"visibility=shadow_map", "vpls=4096", "shadow_map_batch=2048",
                                    "shadow_map_px=8192"}));
      },
      {"8192 x 8192, 2048 layers"});
}

TEST(InstantRadiosity, MorePointsThanTheDeviceHoldsAreRefusedBeforeTheyAreMade) {
  RenderRequest request = request_with({"visibility=imperfect", "imperfect_points=65536"});
  tests::expect_error_with<UnsupportedError>(
      [&] { render(spot_in_box(), request); },
      {"imperfect shadow maps: 65536 points per map; ", " has room for "});
}

TEST(InstantRadiosity, AnUnknownPlatformIsRefusedWithTheKnownOnes) {
  const RendererInfo& info = find_renderer("instant-radiosity", {});
  Devices devices;
  devices.platform = "glx";
  const auto renderer = info.create(parameters_of("instant-radiosity", {}), devices);
  StageTimer timer;
  EXPECT_THROW(renderer->prepare(spot_in_box(), timer), base::InputError);
}

TEST(InstantRadiosity, PlatformsAgree) {
  const scene::Scene scene = boxes_by_light()[2].second;
  const RendererInfo& info = find_renderer("instant-radiosity", {});
  std::vector<Frame> frames;
  for (const char* platform : {"egl-surfaceless", "osmesa"}) {
    Devices devices;
    devices.platform = platform;
    const auto renderer = info.create(
        parameters_of("instant-radiosity",
                      {"vpls=256", "visibility=shadow_map", "shadow_map_px=64", "part=indirect"}),
        devices);
    StageTimer timer;
    renderer->prepare(scene, timer);
    RenderJob job;
    job.width_px = job.height_px = 32;
    job.camera = scene.camera;
    frames.push_back(renderer->render(job, timer));
    EXPECT_EQ(frames.back().gl_platform, platform);
    EXPECT_NE(frames.back().device, "cpu");
  }
  EXPECT_LT(relative_rms(frames[0], frames[1]), 1e-3);
}

}  // namespace
}  // namespace renderers::test
