#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/expect_input_error.h"
#include "tests/renderers/ray_bundles/check_texture.h"
#include "tests/renderers/scene_builder.h"

/// The renderer `ray-bundles` through its contract, against the path tracer.
namespace renderers::test {
namespace {

using Settings = std::vector<std::string>;

/// A closed room with a coloured wall, a block, a lamp and a point light, seen from inside.
SceneBuilder room() {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.7F)));
  const int red = builder.add_material(lambert({0.6F, 0.2F, 0.1F}));
  const int lamp = builder.add_material(lambert(glm::vec3(0.3F), glm::vec3(5.0F)));
  builder.add_quad({-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, white);
  builder.add_quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, white);
  builder.add_quad({-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, white);
  builder.add_quad({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, white);
  builder.add_quad({-1, -1, -1}, {0, 2, 0}, {0, 0, 2}, red);
  builder.add_quad({1, -1, -1}, {0, 0, 2}, {0, 2, 0}, white);
  builder.add_quad({-0.4F, 0.95F, -0.4F}, {0.8F, 0, 0}, {0, 0, 0.8F}, lamp);
  builder.add_box({0.0F, -0.9F, 0.1F}, {0.5F, -0.3F, 0.6F}, white, false);
  builder.add_point_light({-0.5F, 0.3F, -0.2F}, glm::vec3(0.4F));
  builder.look({0.1F, 0.0F, -0.95F}, {0, -0.1F, 1}, 75.0F);
  return builder;
}

Frame bundles(const scene::Scene& scene, Settings settings, std::int64_t samples,
              StageTimer* timer = nullptr) {
  settings.insert(settings.begin(), {"atlas_side=128", "lines=128", "pass_directions=64"});
  return render(scene,
                {.renderer = "ray-bundles",
                 .settings = std::move(settings),
                 .width_px = 48,
                 .height_px = 48,
                 .samples = samples},
                timer);
}

/// Means of an image over the pixels that show surfaces of one of the six attitudes and nothing
/// else. @param truth  by the path tracer: its normals are means over the pixel
std::array<std::array<double, 3>, 6> means_by_attitude(const Frame& truth,
                                                       const perception::Image& image) {
  std::array<std::array<double, 3>, 6> means{};
  std::array<double, 6> counts{};
  const perception::Image& normal = aov(truth, "normal");
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float along = normal.pixels[3 * i + axis];
      if (std::fabs(along) < 0.99F) continue;
      const std::size_t attitude = 2 * axis + (along > 0.0F ? 1 : 0);
      counts[attitude] += 1.0;
      for (std::size_t c = 0; c < 3; ++c) {
        means[attitude][c] += static_cast<double>(image.pixels[3 * i + c]);
      }
    }
  }
  for (std::size_t a = 0; a < 6; ++a) {
    for (double& value : means[a]) value = counts[a] > 0.0 ? value / counts[a] : 0.0;
  }
  return means;
}

/// Largest relative difference of the walls' means.
double wall_error(const perception::Image& image, const Frame& reference,
                  const perception::Image& truth) {
  const auto a = means_by_attitude(reference, image);
  const auto b = means_by_attitude(reference, truth);
  double error = 0.0;
  for (std::size_t wall = 0; wall < 6; ++wall) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (b[wall][c] > 0.0) error = std::max(error, std::fabs(a[wall][c] / b[wall][c] - 1.0));
    }
  }
  return error;
}

/// The path tracer's picture of the room, made once.
const Frame& truth_of_room() {
  static const Frame frame =
      render(room().scene,
             {.settings = {"transport=diffuse"}, .width_px = 48, .height_px = 48, .samples = 256});
  return frame;
}

TEST(RayBundles, WallsHaveThePathTracersMeans) {
  const SceneBuilder builder = room();
  const Frame& truth = truth_of_room();
  for (const char* transfer : {"transfer=scatter", "transfer=gather"}) {
    const Frame frame = bundles(builder.scene, {transfer}, 512);
    EXPECT_LT(wall_error(frame.radiance, truth, truth.radiance), 0.01) << transfer;
    EXPECT_LT(wall_error(aov(frame, "indirect"), truth, aov(truth, "indirect")), 0.015) << transfer;
    EXPECT_LT(wall_error(aov(frame, "direct"), truth, aov(truth, "direct")), 0.01) << transfer;
  }
}

/// Emission met by bundles, or sampled and left out of them: the same light, once.
TEST(RayBundles, LightIsCountedOnceWhicheverWayItComes) {
  const SceneBuilder builder = room();
  const Frame& truth = truth_of_room();
  const Frame met = bundles(builder.scene, {"direct=bundles"}, 1024);
  EXPECT_LT(wall_error(met.radiance, truth, truth.radiance), 0.02);
  EXPECT_LT(wall_error(aov(met, "indirect"), truth, aov(truth, "indirect")), 0.02);
  const Frame sampled = bundles(builder.scene, {"part=indirect"}, 512);
  const Frame whole = bundles(builder.scene, {}, 512);
  EXPECT_EQ(sampled.radiance.pixels, aov(whole, "indirect").pixels);
  // Twice the direct light, or none of it, would be far outside.
  const double direct = mean_of(aov(truth, "direct"));
  EXPECT_GT(direct, 0.2 * mean_of(truth.radiance));
}

TEST(RayBundles, ThePapersMeanIsDarkerThanTheGrowingStep) {
  const SceneBuilder builder = room();
  const Frame& truth = truth_of_room();
  const double expected = mean_of(aov(truth, "indirect"));
  const double grown = mean_of(bundles(builder.scene, {"part=indirect"}, 256).radiance);
  const double averaged =
      mean_of(bundles(builder.scene, {"part=indirect", "feed=running_mean"}, 256).radiance);
  EXPECT_NEAR(grown, expected, 0.015 * expected);
  EXPECT_LT(averaged, 0.96 * expected);
  const double bounced =
      mean_of(bundles(builder.scene, {"part=indirect", "feed=jacobi", "bounces=8"}, 512).radiance);
  EXPECT_NEAR(bounced, expected, 0.05 * expected);
}

TEST(RayBundles, TexturesEnvironmentAndBothSides) {
  SceneBuilder builder;
  builder.scene.textures.push_back(check_texture({1.0F, 0.8F, 0.6F}, {0.2F, 0.3F, 0.4F}));
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
             {.settings = {"transport=diffuse"}, .width_px = 48, .height_px = 48, .samples = 256});
  for (const char* direct : {"direct=next_event", "direct=bundles"}) {
    const Frame frame = bundles(builder.scene, {direct}, 768);
    EXPECT_LT(wall_error(frame.radiance, truth, truth.radiance), 0.02) << direct;
  }
  const Frame blind = bundles(builder.scene, {"sides=front", "direct=bundles"}, 64);
  EXPECT_GT(wall_error(blind.radiance, truth, truth.radiance), 0.2);
}

TEST(RayBundles, SameBytesForEveryNumberOfThreads) {
  const SceneBuilder builder = room();
  for (const char* transfer : {"transfer=scatter", "transfer=gather"}) {
    RenderRequest request{.renderer = "ray-bundles",
                          .settings = {"atlas_side=64", "lines=64", transfer, "camera_rays=2"},
                          .samples = 20,
                          .threads = 1};
    const Frame one = render(builder.scene, request);
    request.threads = 3;
    EXPECT_EQ(render(builder.scene, request).radiance.pixels, one.radiance.pixels) << transfer;
    request.seed = 2;
    EXPECT_NE(render(builder.scene, request).radiance.pixels, one.radiance.pixels) << transfer;
  }
}

TEST(RayBundles, CheckpointsAreThePicturesOfFewerDirections) {
  const SceneBuilder builder = room();
  for (const char* directions : {"directions=halton_permuted", "directions=halton"}) {
    RenderRequest request{.renderer = "ray-bundles",
                          .settings = {"atlas_side=64", "lines=64", directions, "camera_rays=2"},
                          .samples = 20};
    std::vector<std::pair<std::int64_t, std::vector<float>>> seen;
    request.change_job = [&](RenderJob& job) {
      job.checkpoint = [&](const perception::Image& image, std::int64_t samples) {
        seen.emplace_back(samples, image.pixels);
      };
    };
    render(builder.scene, request);
    ASSERT_EQ(seen.size(), 5U);
    request.change_job = nullptr;
    for (const auto& [samples, pixels] : seen) {
      request.samples = samples;
      EXPECT_EQ(render(builder.scene, request).radiance.pixels, pixels) << samples;
    }
  }
}

/// Renderer, its timer and the job, for what happens between two renderings.
struct Session {
  explicit Session(const Settings& settings = {"atlas_side=64", "lines=64", "camera_rays=2"})
      : renderer(
            find_renderer("ray-bundles", {}).create(parameters_of("ray-bundles", settings), {})) {
    job.width_px = job.height_px = 16;
    job.samples = 40;
  }
  std::unique_ptr<Renderer> renderer;
  StageTimer timer;
  RenderJob job;

  std::vector<float> pixels(const scene::Camera& camera) {
    job.camera = camera;
    return renderer->render(job, timer).radiance.pixels;
  }
  std::int64_t bundle_count() const {
    for (const StageRecord& record : timer.records()) {
      if (record.path == "visibility") return record.calls;
    }
    return 0;
  }
};

TEST(RayBundles, ANewViewKeepsTheSolutionAndANewSceneDoesNot) {
  SceneBuilder builder = room();
  Session session;
  session.renderer->prepare(builder.scene, session.timer);
  session.pixels(builder.scene.camera);
  EXPECT_EQ(session.bundle_count(), 40);
  builder.look({0.5F, 0.5F, -0.9F}, {-0.3F, -0.5F, 0.8F}, 60.0F);
  const auto moved = session.pixels(builder.scene.camera);
  EXPECT_EQ(session.bundle_count(), 40);

  Session fresh;
  fresh.renderer->prepare(builder.scene, fresh.timer);
  EXPECT_EQ(fresh.pixels(builder.scene.camera), moved);

  // The block gone: nothing of its shadow stays.
  scene::Scene cleared = builder.scene;
  cleared.objects.resize(7);
  session.renderer->update(cleared, session.timer);
  const auto updated = session.pixels(cleared.camera);
  EXPECT_NE(updated, moved);
  Session anew;
  anew.renderer->prepare(cleared, anew.timer);
  EXPECT_EQ(anew.pixels(cleared.camera), updated);
}

/// The room with checks on its red wall, so that the picture needs coordinates of vertices.
SceneBuilder checked_room() {
  SceneBuilder builder = room();
  builder.scene.textures.push_back(check_texture({1.0F, 1.0F, 1.0F}, {0.1F, 0.2F, 0.3F}));
  builder.scene.materials[1].albedo_texture = 0;
  return builder;
}

/// A walk through a world that stays: each frame is what a cold start makes of it.
TEST(RayBundles, AFrameWithAnotherCameraAloneKeepsTheSolution) {
  for (const char* direct : {"direct=next_event", "direct=bundles"}) {
    const Settings settings{"atlas_side=64", "lines=64", "camera_rays=2", direct};
    SceneBuilder builder = checked_room();
    builder.scene.world_hash = base::hash_of("room");
    Session session(settings);
    {
      // Of its own meshes, which go with it.
      scene::Scene first = builder.scene;
      for (scene::Object& object : first.objects) {
        object.mesh = std::make_shared<const scene::Mesh>(*object.mesh);
      }
      session.renderer->prepare(first, session.timer);
      session.pixels(first.camera);
      builder.look({0.2F, 0.3F, -0.9F}, {0.9F, -0.2F, 0.8F}, 60.0F);
      session.job.frame_index = 1;
      session.renderer->update(builder.scene, session.timer);
    }
    EXPECT_EQ(session.bundle_count(), 40) << direct;
    for (int frame = 1; frame <= 3; ++frame) {
      builder.look({0.2F * static_cast<float>(frame), 0.3F, -0.9F}, {-0.9F, -0.2F, 0.8F}, 60.0F);
      session.job.frame_index = frame;
      session.renderer->update(builder.scene, session.timer);
      const auto kept = session.pixels(builder.scene.camera);
      EXPECT_EQ(session.bundle_count(), 40) << direct << " " << frame;
      Session cold(settings);
      cold.job.frame_index = frame;
      cold.renderer->prepare(builder.scene, cold.timer);
      EXPECT_EQ(cold.pixels(builder.scene.camera), kept) << direct << " " << frame;
    }
    builder.scene.world_hash = base::hash_of("another room");
    session.renderer->update(builder.scene, session.timer);
    session.pixels(builder.scene.camera);
    EXPECT_EQ(session.bundle_count(), 80) << direct;
  }
}

/// A session that has prepared and rendered, and what its stages have of the processor's time,
/// which unlike that of the clock does not pass while other programs run.
struct TimedSession {
  Session session{{"atlas_side=256", "lines=256"}};
  Frame frame;
  double staged_share = 0.0;

  explicit TimedSession(const scene::Scene& scene) {
    session.job.samples = 64;
    session.job.camera = scene.camera;
    StageTimer& timer = session.timer;
    const double start_s = process_cpu_seconds();
    session.renderer->prepare(scene, timer);
    timer.set_phase(Phase::render);
    frame = session.renderer->render(session.job, timer);
    const double total_s = process_cpu_seconds() - start_s;
    double staged_s = 0.0;
    for (const StageRecord& record : timer.records()) {
      if (record.path.find('/') == std::string::npos) staged_s += record.cpu_s;
    }
    staged_share = staged_s / total_s;
  }
};

TEST(RayBundles, StagesMakeUpTheTime) {
  const SceneBuilder builder = room();
  const TimedSession timed(builder.scene);
  EXPECT_GT(timed.staged_share, 0.95);
  const StageTimer& timer = timed.session.timer;
  const Frame& frame = timed.frame;
  EXPECT_GT(timer.wall_of("visibility"), 0.0);
  EXPECT_GT(timer.wall_of("build/atlas"), 0.0);
  EXPECT_EQ(frame.samples, 64);
  EXPECT_EQ(counter(frame, "directions"), 64.0);
  EXPECT_EQ(counter(frame, "overflow"), 0.0);
  EXPECT_GT(counter(frame, "fragments"), counter(frame, "lines"));
  EXPECT_GT(counter(frame, "lit_pairs"), 0.0);
  EXPECT_LE(counter(frame, "lit_pairs"), counter(frame, "pairs"));
}

TEST(RayBundles, ATimeBudgetEndsThePicture) {
  RenderRequest request{.renderer = "ray-bundles",
                        .settings = {"atlas_side=64", "lines=64", "camera_rays=1"},
                        .samples = 0};
  request.change_job = [](RenderJob& job) { job.time_budget_s = 0.3; };
  const Frame frame = render(room().scene, request);
  EXPECT_GT(frame.samples, 4);
  EXPECT_LT(frame.samples, 100'000);
}

TEST(RayBundles, SaysWhatItCannotDo) {
  SceneBuilder builder = room();
  builder.scene.name = "room";
  EXPECT_EQ(
      tests::input_error_of([&] {
        render(builder.scene, {.renderer = "ray-bundles", .settings = {"atlas_side=8"}});
      }),
      "texel atlas: 13 charts of scene \"room\" do not fit into 8 x 8 texels, not even with a "
      "texel each; accepted: a larger atlas_side, or charts=connected");
}

/// A glossy lobe acts at the surface that the camera sees.
TEST(RayBundles, GlossActsAtTheLastSurface) {
  SceneBuilder builder = room();
  const int glossy = builder.add_material(phong({0.2F, 0.2F, 0.3F}, glm::vec3(0.5F), 20.0F));
  builder.scene.objects[0].material = glossy;
  builder.scene.objects[2].material = glossy;
  const Frame truth =
      render(builder.scene,
             {.settings = {"transport=diffuse"}, .width_px = 48, .height_px = 48, .samples = 256});
  for (const auto& [direct, directions] :
       {std::pair{"direct=next_event", 512}, std::pair{"direct=bundles", 1024}}) {
    const Frame frame = bundles(builder.scene, {direct, "camera_rays=8"}, directions);
    EXPECT_LT(wall_error(frame.radiance, truth, truth.radiance), 0.03) << direct;
    EXPECT_LT(wall_error(aov(frame, "indirect"), truth, aov(truth, "indirect")), 0.02) << direct;
  }
  builder.scene.materials[static_cast<std::size_t>(glossy)].lobe.albedo = glm::vec3(0.0F);
  const Frame dull = bundles(builder.scene, {}, 128);
  EXPECT_GT(wall_error(aov(dull, "indirect"), truth, aov(truth, "indirect")), 0.2);
}

/// A k-buffer that is too small by far is drawn into until nothing is left: the picture of counted
/// lists, to the bit. In one pass light leaks, and is counted.
TEST(RayBundles, TooFewSlotsAreFilledAgain) {
  const SceneBuilder builder = room();
  const Frame counted = bundles(builder.scene, {}, 32);
  for (const char* slots : {"slots=1", "slots=2", "slots=3"}) {
    const Frame frame = bundles(builder.scene, {"lists=fixed_k", slots}, 32);
    EXPECT_EQ(frame.radiance.pixels, counted.radiance.pixels) << slots;
    EXPECT_EQ(counter(frame, "overflow"), 0.0);
    EXPECT_GT(counter(frame, "passes"), counter(counted, "passes"));
  }
  const Frame leaking = bundles(builder.scene, {"lists=fixed_k", "slots=1", "slot_passes=one"}, 32);
  EXPECT_NE(leaking.radiance.pixels, counted.radiance.pixels);
  EXPECT_GT(counter(leaking, "overflow"), 0.0);
  EXPECT_FALSE(leaking.notes.empty());
}

/// Direct light alone, and claimed so.
TEST(RayBundles, PathsMayBeDirectOnes) {
  SceneBuilder builder = room();
  const int glossy = builder.add_material(phong({0.2F, 0.2F, 0.3F}, glm::vec3(0.5F), 5.0F));
  builder.scene.objects[2].material = glossy;
  const Frame truth =
      render(builder.scene,
             {.settings = {"transport=direct"}, .width_px = 48, .height_px = 48, .samples = 256});
  for (const char* direct : {"direct=bundles", "direct=next_event"}) {
    const Frame frame = bundles(builder.scene, {"paths=direct", direct, "camera_rays=8"}, 1024);
    EXPECT_LT(wall_error(frame.radiance, truth, truth.radiance), 0.03) << direct;
    EXPECT_EQ(mean_of(aov(frame, "indirect")), 0.0);
  }
  const RendererInfo& info = find_renderer("ray-bundles", {});
  EXPECT_EQ(info.claims(parameters_of("ray-bundles", {"paths=direct"}), builder.scene).transport,
            Transport::direct);
  EXPECT_EQ(tests::input_error_of([&] {
              bundles(builder.scene, {"paths=direct", "part=indirect"}, 4);
            }),
            "ray-bundles: paths direct with part indirect or feed jacobi leaves no light; "
            "accepted: part all and another feed");
}

TEST(RayBundles, AnEmptySceneIsItsEnvironment) {
  SceneBuilder builder;
  builder.set_environment(glm::vec3(0.25F));
  for (const char* direct : {"direct=next_event", "direct=bundles"}) {
    const Frame frame = bundles(builder.scene, {direct}, 4);
    for (const float value : frame.radiance.pixels) EXPECT_NEAR(value, 0.25F, 1e-6F);
  }
}

}  // namespace
}  // namespace renderers::test
