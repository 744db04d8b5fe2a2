#include "renderers/clustered_visibility/clustered_visibility_renderer.h"

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

const char* const kVisibilities[]{"visibility=oracle", "visibility=hard", "visibility=pcf",
                                  "visibility=cssm", "visibility=msm"};

RenderRequest request_with(std::vector<std::string> settings, int width_px = 20,
                           int height_px = 20) {
  RenderRequest request;
  request.renderer = "clustered-visibility";
  request.settings = std::move(settings);
  for (const char* small : {"light_map_px=64", "area_light_map_px=32", "shadow_map_px=32"}) {
    request.settings.insert(request.settings.begin(), small);
  }
  request.width_px = width_px;
  request.height_px = height_px;
  request.samples = 0;
  return request;
}

/// The same lights with a visibility each.
RenderRequest plain_request(const char* visibility, std::vector<std::string> settings) {
  RenderRequest request = request_with(std::move(settings));
  request.renderer = "instant-radiosity";
  request.settings.emplace_back(visibility);
  return request;
}

bool is_finite(const Frame& frame) {
  return std::ranges::all_of(frame.radiance.pixels, [](float v) { return std::isfinite(v); });
}

bool has_note(const Frame& frame, const std::string& note) {
  return std::ranges::find(frame.notes, note) != frame.notes.end();
}

TEST(ClusteredVisibility, AsManyAreaLightsAsLightsWithOneTestAreShadowMapsBitForBit) {
  const scene::Scene scene = spot_in_box();
  const std::vector<std::string> same{"vpls=64", "interleave=1", "part=indirect"};
  std::vector<std::string> clustered = same;
  for (const char* more : {"vals=64", "visibility=hard", "cluster_start=stride"}) {
    clustered.emplace_back(more);
  }
  const Frame area = render(scene, request_with(clustered));
  const Frame point = render(scene, plain_request("visibility=shadow_map", same));
  EXPECT_EQ(counter(area, "vals"), counter(point, "valid_vpls"));
  EXPECT_EQ(area.radiance.pixels, point.radiance.pixels);
  EXPECT_GT(mean_radiance(area), 0.0);
}

TEST(ClusteredVisibility, TheOracleOfSingleLightsIsOneRayEach) {
  const scene::Scene scene = spot_in_box();
  const std::vector<std::string> same{"vpls=64", "interleave=1", "part=indirect"};
  std::vector<std::string> clustered = same;
  for (const char* more : {"vals=64", "visibility=oracle"}) clustered.emplace_back(more);
  const Frame area = render(scene, request_with(clustered));
  const Frame point = render(scene, plain_request("visibility=ray", same));
  EXPECT_LT(relative_rms(area, point), 1e-6);
  EXPECT_EQ(counter(area, "visibility_rays"), counter(point, "visibility_rays"));
}

TEST(ClusteredVisibility, TheErrorOfClusteringFallsWithTheNumberOfAreaLights) {
  const scene::Scene scene = spot_in_box();
  const std::vector<std::string> same{"vpls=256", "interleave=1", "part=indirect"};
  const Frame truth = render(scene, plain_request("visibility=ray", same));
  const auto error = [&](const char* visibility, const char* vals) {
    std::vector<std::string> settings = same;
    settings.emplace_back(visibility);
    settings.emplace_back(vals);
    return relative_rms(render(scene, request_with(settings)), truth);
  };
  const double few = error("visibility=oracle", "vals=2");
  const double many = error("visibility=oracle", "vals=30");
  EXPECT_LT(many, 0.6 * few);
  EXPECT_LT(many, 0.01);
  EXPECT_LE(many, error("visibility=hard", "vals=30"));
  const double none = relative_rms(render(scene, plain_request("visibility=none", same)), truth);
  for (const char* visibility : kVisibilities) EXPECT_LT(error(visibility, "vals=30"), 0.5 * none);
}

TEST(ClusteredVisibility, EveryVisibilityGivesTheSameBytesAgainAndOnAnyNumberOfThreads) {
  const scene::Scene scene = boxes_by_light()[2].second;
  for (const char* visibility : kVisibilities) {
    RenderRequest request = request_with({"vpls=128", "vals=10", visibility});
    const Frame once = render(scene, request);
    request.threads = 1;
    EXPECT_EQ(once.radiance.pixels, render(scene, request).radiance.pixels) << visibility;
    EXPECT_TRUE(is_finite(once)) << visibility;
    EXPECT_GT(mean_radiance(once), 0.0) << visibility;
  }
}

TEST(ClusteredVisibility, EveryWayToFillMapsGivesNearlyThePictureOfTheExactOne) {
  const scene::Scene scene = spot_in_box();
  const auto picture = [&](std::vector<std::string> settings) {
    for (const char* same :
         {"vpls=128", "vals=10", "interleave=1", "part=indirect", "visibility=hard"}) {
      settings.emplace_back(same);
    }
    return render(scene, request_with(std::move(settings), 32, 32));
  };
  const Frame exact = picture({"depth=exact"});
  EXPECT_LT(relative_rms(picture({"depth=hemicube"}), exact), 0.006);
  const Frame cut = picture({"depth=vertex"});
  const double error = relative_rms(cut, exact);
  EXPECT_LT(error, 0.006);
  // Corners alone are not enough: the chords of a box's large triangles cut off what they hide.
  const double uncut_error = relative_rms(picture({"depth=vertex", "tessellated_edge=0"}), exact);
  EXPECT_GT(uncut_error, 4.0 * error);
  EXPECT_GT(counter(cut, "shadow_triangles"), 10.0 * counter(exact, "shadow_triangles"));
}

TEST(ClusteredVisibility, PicturesOfSingleAreaLightsAddUpToThatOfAll) {
  const scene::Scene scene = spot_in_box();
  for (const char* visibility : {"visibility=cssm", "visibility=oracle"}) {
    const auto picture = [&](const std::string& only) {
      return render(scene, request_with({"vpls=64", "vals=4", "interleave=1", "part=indirect",
                                         visibility, "only_val=" + only}));
    };
    const Frame all = picture("-1");
    Frame sum = picture("0");
    EXPECT_LT(mean_radiance(sum), 0.9 * mean_radiance(all));
    for (const char* only : {"1", "2", "3"}) {
      const Frame one = picture(only);
      for (std::size_t i = 0; i < sum.radiance.pixels.size(); ++i) {
        sum.radiance.pixels[i] += one.radiance.pixels[i];
      }
    }
    EXPECT_LT(relative_rms(sum, all), 1e-6) << visibility;
  }
}

TEST(ClusteredVisibility, TheDriverHasNothingToComplainOf) {
  const scene::Scene scene = glossy_box();
  const RendererInfo& info = find_renderer("clustered-visibility", {});
  Devices devices;
  devices.warm = std::make_shared<WarmStore>();
  for (const char* visibility : kVisibilities) {
    RenderRequest request =
        request_with({"vpls=128", "vals=8", "show_lights=true", "shown_vals=2", visibility});
    if (std::string(visibility) == "visibility=cssm") {
      for (const char* more : {"prefilter=sat", "terms=4"}) request.settings.emplace_back(more);
    }
    const auto renderer = info.create(parameters_of(request.renderer, request.settings), devices);
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

/// Pictures of a sequence by one renderer that is kept.
std::vector<std::vector<float>> pictures_of(const std::vector<scene::Scene>& frames,
                                            const RenderRequest& request) {
  const auto kept = find_renderer(request.renderer, {})
                        .create(parameters_of(request.renderer, request.settings), {});
  StageTimer timer;
  std::vector<std::vector<float>> pictures;
  for (const scene::Scene& frame : frames) {
    if (pictures.empty()) {
      kept->prepare(frame, timer);
    } else {
      kept->update(frame, timer);
    }
    RenderJob job;
    job.width_px = request.width_px;
    job.height_px = request.height_px;
    job.camera = frame.camera;
    pictures.push_back(kept->render(job, timer).radiance.pixels);
  }
  return pictures;
}

TEST(ClusteredVisibility, AFrameOfASequenceIsThatOfAColdStartUnlessClustersStartWarm) {
  const std::vector<scene::Scene> frames{spot_in_box(), boxes_by_light()[0].second, glossy_box()};
  RenderRequest request = request_with({"vpls=128", "vals=12", "interleave=4"});
  const auto restarted = pictures_of(frames, request);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(restarted[i], render(frames[i], request).radiance.pixels) << "frame " << i;
  }
  request.settings.emplace_back("warm_start=true");
  const auto warm = pictures_of(frames, request);
  EXPECT_EQ(warm[0], restarted[0]);
  EXPECT_NE(warm[1], restarted[1]);
}

TEST(ClusteredVisibility, ChangesFromFrameToFrameAreCounted) {
  scene::Scene scene = spot_in_box();
  const RenderRequest request = request_with({"vpls=128", "vals=8"});
  const auto kept = find_renderer(request.renderer, {})
                        .create(parameters_of(request.renderer, request.settings), {});
  StageTimer timer;
  kept->prepare(scene, timer);
  RenderJob job;
  job.width_px = job.height_px = 8;
  job.camera = scene.camera;
  const Frame first = kept->render(job, timer);
  EXPECT_THROW(counter(first, "assignment_churn"), std::exception);
  kept->update(scene, timer);
  const Frame same = kept->render(job, timer);
  EXPECT_EQ(counter(same, "assignment_churn"), 0.0);
  EXPECT_EQ(counter(same, "val_shift_p95"), 0.0);
  scene.lights.front().position.x += 0.1F;
  kept->update(scene, timer);
  const Frame moved = kept->render(job, timer);
  EXPECT_GT(counter(moved, "val_shift_p95"), 0.0);
  EXPECT_LT(counter(moved, "val_shift_p50"), 0.1);
}

TEST(ClusteredVisibility, EveryIntermediateCanBeSeen) {
  const Frame frame = render(
      spot_in_box(), request_with({"vpls=256", "vals=8", "show_lights=true", "shown_vals=2"}));
  for (const char* name : {"direct", "indirect", "irradiance", "albedo", "normal", "clusters",
                           "vpls", "light_count", "val_0", "val_1"}) {
    EXPECT_GT(*std::ranges::max_element(aov(frame, name).pixels), 0.0F) << name;
  }
  const std::vector<float>& shown = aov(frame, "val_0").pixels;
  EXPECT_LE(*std::ranges::max_element(shown), 1.0F);
  EXPECT_LT(*std::ranges::min_element(shown), 1.0F);
  EXPECT_EQ(*std::ranges::max_element(aov(frame, "light_count").pixels), 4.0F);  // 256 / 8 / 8
}

TEST(ClusteredVisibility, PicturesNeedNotBeMultiplesOfTheInterleave) {
  const scene::Scene scene = spot_in_box();
  for (const auto& [width_px, height_px] : {std::pair{1, 1}, {7, 5}, {8, 17}}) {
    const Frame frame = render(scene, request_with({"vpls=100", "vals=5"}, width_px, height_px));
    EXPECT_TRUE(is_finite(frame));
    EXPECT_GT(mean_radiance(frame), 0.0);
  }
}

TEST(ClusteredVisibility, LightsOfOnePlaneAreSaidToBe) {
  SceneBuilder builder;
  builder.add_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0},
                   builder.add_material(lambert(glm::vec3(0.5F))));
  builder.add_point_light({0.0F, 1.0F, 0.0F}, glm::vec3(5.0F));
  builder.look({0, 2, -3}, {0, 0, 0}, 60.0F);
  for (const char* visibility : kVisibilities) {
    const Frame frame = render(builder.scene, request_with({"vpls=64", "vals=4", visibility}));
    EXPECT_TRUE(is_finite(frame)) << visibility;
    EXPECT_TRUE(has_note(frame, "all virtual lights lie in one plane")) << visibility;
  }
  const Frame room = render(spot_in_box(), request_with({"vpls=64", "vals=4"}));
  EXPECT_FALSE(has_note(room, "all virtual lights lie in one plane"));
}

TEST(ClusteredVisibility, WithoutLightThePictureIsBlackAndSaysSo) {
  scene::Scene scene = spot_in_box();
  scene.lights.clear();
  for (const char* visibility : kVisibilities) {
    const Frame frame = render(scene, request_with({"vpls=64", visibility}));
    EXPECT_EQ(*std::ranges::max_element(frame.radiance.pixels), 0.0F) << visibility;
    EXPECT_TRUE(has_note(frame, "no light reaches a surface: no indirect light"));
    EXPECT_EQ(counter(frame, "vals"), 0.0);
  }
}

TEST(ClusteredVisibility, ALightInsideABlockLightsNothingOutside) {
  scene::Scene scene = spot_in_box();
  scene.lights.front().position = {-0.2F, 0.4F, 0.75F};
  const Frame lit = render(spot_in_box(), request_with({"vpls=256", "part=indirect"}));
  for (const char* visibility : kVisibilities) {
    const Frame frame = render(scene, request_with({"vpls=256", "part=indirect", visibility}));
    EXPECT_TRUE(is_finite(frame)) << visibility;
    // Maps of 32 px leak along the block's edges, a series of 8 terms next to all of its sides.
    EXPECT_LT(mean_radiance(frame), 0.2 * mean_radiance(lit)) << visibility;
  }
  const Frame oracle =
      render(scene, request_with({"vpls=256", "part=indirect", "visibility=oracle"}));
  EXPECT_LT(*std::ranges::max_element(oracle.radiance.pixels), 1e-4F);
}

TEST(ClusteredVisibility, UnitsDoNotMatter) {
  for (const std::vector<std::string>& settings : std::vector<std::vector<std::string>>{
           {"visibility=msm"},
           {"visibility=cssm"},
           {"visibility=pcf", "depth=hemicube"},
           {"visibility=hard", "depth=vertex", "cluster_sums=scatter"}}) {
    std::vector<std::string> all{"vpls=256", "vals=12", "part=indirect"};
    all.insert(all.end(), settings.begin(), settings.end());
    const RenderRequest request = request_with(all);
    const Frame metres = render(spot_in_box(), request);
    for (const float scale : {1.0F / 1024.0F, 1024.0F}) {
      EXPECT_LT(relative_rms(render(scaled(spot_in_box(), scale), request), metres), 0.01)
          << settings.front() << " " << scale;
    }
  }
}

TEST(ClusteredVisibility, DrawsAsOftenAsItsMapsAsk) {
  const auto draws = [](std::vector<std::string> settings) {
    settings.emplace_back("vpls=64");
    settings.emplace_back("vals=4");
    return counter(render(spot_in_box(), request_with(settings)), "shadow_draws");
  };
  EXPECT_EQ(draws({"depth=exact"}), 0.0);
  EXPECT_EQ(draws({"depth=vertex"}), 1.0) << "instanced into the layers";
  EXPECT_EQ(draws({"depth=vertex", "layer_choice=per_layer"}), 4.0);
  EXPECT_EQ(draws({"depth=hemicube"}), 20.0);
  EXPECT_EQ(draws({"visibility=oracle"}), 0.0);
}

TEST(ClusteredVisibility, PlatformsAgree) {
  const scene::Scene scene = spot_in_box();
  std::vector<Frame> frames;
  for (const char* platform : {"egl-surfaceless", "osmesa"}) {
    Devices devices;
    devices.platform = platform;
    const RenderRequest request = request_with({"vpls=256", "part=indirect"});
    const auto renderer = find_renderer(request.renderer, {})
                              .create(parameters_of(request.renderer, request.settings), devices);
    StageTimer timer;
    renderer->prepare(scene, timer);
    RenderJob job;
    job.width_px = job.height_px = 32;
    job.camera = scene.camera;
    frames.push_back(renderer->render(job, timer));
    EXPECT_EQ(frames.back().gl_platform, platform);
  }
  EXPECT_LT(relative_rms(frames[0], frames[1]), 1e-3);
}

}  // namespace
}  // namespace renderers::test
