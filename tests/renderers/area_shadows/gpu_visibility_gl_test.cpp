#include "renderers/area_shadows/gpu_visibility.h"

#include <bit>
#include <filesystem>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "renderers/gpu_tracing/triangle_bvh.h"
#include "renderers/scene/scene_file.h"
#include "tests/expect_input_error.h"
#include "tests/places.h"
#include "tests/renderers/area_shadows/polygon_irradiance.h"
#include "tests/renderers/scene_builder.h"

/// Shadow rays by compute shaders of the device, held against Embree's: bits, pictures, counters.
namespace renderers::area_shadows {
namespace {

using ray_tracing::RayScene;

/// M6: at most so many of a scene's bits may differ, by roundings where rays graze edges.
constexpr double kMostDiffering = 1e-5;
/// By so much rays and fragments of a picture may differ then, as a share.
constexpr double kMostOtherwise = 0.02;

scene::Scene catalogue_scene(const std::string& name) {
  const auto path =
      std::filesystem::path(tests::kSourceFolder) / "suites" / "scenes" / (name + ".yaml");
  return scene::read_scene_file(path).at_frame(0);
}

std::shared_ptr<opengl::Context> shared_context() {
  static const auto context = opengl::Context::create("auto");
  return context;
}

/// Every light point at every pixel of a scene.
struct Comparison {
  std::uint64_t rays = 0;
  std::uint64_t hidden = 0;
  std::uint64_t differing = 0;
  std::string list;  ///< of the differing ones
};

using PixelBits = std::vector<std::vector<std::uint16_t>>;

PixelBits bits_of(PointVisibility& visibility, const LitPixels& lit, StageTimer& timer,
                  RayCounts& counts) {
  PixelBits bits(lit.surfaces.pixels.size());
  counts = visit_pixels(visibility, lit, timer, [&](const PixelPoints& points) {
    bits[points.pixel].assign(points.visible.begin(), points.visible.end());
  });
  return bits;
}

Comparison compare(const scene::Scene& scene, int width_px, int height_px) {
  StageTimer timer;
  const RayScene rays(scene, timer);
  RenderJob job;
  job.width_px = width_px;
  job.height_px = height_px;
  job.camera = scene.camera;
  const PixelSurfaces surfaces = find_pixel_surfaces(rays, job);
  const auto lights = ray_tracing::make_light_points(rays, 64, 1);
  const auto pixels = surface_pixels(surfaces);
  const LitPixels lit{surfaces, lights, pixels};
  EmbreeVisibility embree(rays, surfaces, lights);
  DeviceRays device(shared_context());
  device.bvh.load(gpu_tracing::build_bvh(rays), timer);
  GpuVisibility gpu(device, surfaces, lights, timer);
  Comparison result;
  RayCounts of_embree;
  const PixelBits expected = bits_of(embree, lit, timer, of_embree);
  RayCounts of_gpu;
  const PixelBits found = bits_of(gpu, lit, timer, of_gpu);
  result.rays = of_embree.rays;
  EXPECT_NEAR(static_cast<double>(of_gpu.unhidden), static_cast<double>(of_embree.unhidden),
              kMostDiffering * static_cast<double>(result.rays));
  std::uint64_t seen = 0;
  for (const std::uint32_t pixel : pixels) {
    std::size_t place = 0;
    for (std::size_t light = 0; light < lights.size(); ++light) {
      for (std::size_t group = 0; group < lights[light].group_count(); ++group, ++place) {
        seen += static_cast<std::uint64_t>(std::popcount(expected[pixel][place]));
        for (std::uint32_t left =
                 static_cast<std::uint32_t>(expected[pixel][place]) ^ found[pixel][place];
             left != 0; left &= left - 1) {
          ++result.differing;
          result.list += fmt::format(
              "\n  pixel {}, {}, light {}, point {}", static_cast<int>(pixel) % width_px,
              static_cast<int>(pixel) / width_px, light,
              group * lights[light].group_size + static_cast<std::size_t>(std::countr_zero(left)));
        }
      }
    }
  }
  EXPECT_EQ(of_embree.unhidden, seen);
  result.hidden = result.rays - seen;
  return result;
}

class GpuVisibilityGlTest : public testing::TestWithParam<const char*> {};
// Bars a hundredth as wide as the lamp; a bar of a pixel; a mesh; rooms; a mesh and gloss.
INSTANTIATE_TEST_SUITE_P(Scenes, GpuVisibilityGlTest,
                         testing::Values("penumbra-fence", "bar-under-lamp", "cornell-bunny",
                                         "common-atrium", "several-area-lights", "glossy-head"));

TEST_P(GpuVisibilityGlTest, BitsAreEmbrees) {
  scene::Scene scene = catalogue_scene(GetParam());
  if (!scene.environment) {  // directions are targets, too
    test::SceneBuilder sky;
    sky.set_environment(glm::vec3(0.5F));
    scene.environment = sky.scene.environment;
  }
  const Comparison found = compare(scene, 80, 60);
  RecordProperty("rays", static_cast<int>(found.rays));
  RecordProperty("differing", static_cast<int>(found.differing));
  EXPECT_LE(static_cast<double>(found.differing), kMostDiffering * static_cast<double>(found.rays))
      << found.differing << " of " << found.rays << " bits differ:" << found.list;
  EXPECT_GT(found.rays, 100'000U);
  EXPECT_GT(found.hidden, found.rays / 500);
}

/// Floor, ball and a glossy box under two lamps and the sky, part of it before the background.
scene::Scene still_life() {
  test::SceneBuilder builder;
  const int white = builder.add_material(test::lambert({0.8F, 0.7F, 0.6F}));
  const int lamp = builder.add_material(test::lambert(glm::vec3(0.0F), glm::vec3(5.0F)));
  const int gloss = builder.add_material(test::phong(glm::vec3(0.3F), glm::vec3(0.3F), 6.0F));
  builder.add_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, white);
  builder.add_quad({-2, 0, 2}, {0, 1.5F, 0}, {4, 0, 0}, white);
  builder.add_quad({-1, 2.4F, 0}, {0.6F, 0, 0}, {0, 0, 0.6F}, lamp);
  builder.add_quad({0.9F, 2.2F, 0.4F}, {0.3F, 0, 0}, {0, 0, 0.5F}, lamp);
  builder.add_sphere({0.4F, 0.5F, 0.5F}, 0.5F, 32, white);
  builder.add_box({-1.0F, 0.0F, 0.2F}, {-0.5F, 0.9F, 0.7F}, gloss, false);
  builder.add_point_light({1.2F, 1.5F, -0.5F}, glm::vec3(0.5F));
  builder.set_environment({0.3F, 0.4F, 0.5F});
  builder.look({0.3F, 1.2F, -3.6F}, {0, 0.7F, 0.5F}, 45.0F);
  return builder.scene;
}

struct Method {
  const char* renderer;
  std::vector<std::string> settings;
};

const std::vector<Method> kMethods{
    {"multires-shadows", {}},
    {"multires-shadows", {"reuse=false", "audit=true"}},
    {"multires-shadows", {"test_points=same", "bit_threshold=1", "free_level=0", "estimate=sum"}},
    {"multires-shadows", {"rays_per_quadrant=4"}},
    {"nichols-shadows", {}},
    {"grid-shadows", {}},
    {"per-pixel-shadows", {}},
    {"per-pixel-shadows", {"light_points=256"}},
};

Frame picture(const Method& method, const char* backend, StageTimer* timer = nullptr) {
  test::RenderRequest request{.renderer = method.renderer,
                              .settings = method.settings,
                              .width_px = 75,
                              .height_px = 53,
                              .samples = 0};
  request.settings.push_back(std::string("backend=") + backend);
  return test::render(still_life(), request, timer);
}

/// Of equal bits; and of some that differ by rounding, which may split a fragment or two.
void expect_alike(const Frame& gpu, const Frame& embree, bool is_same) {
  ASSERT_EQ(gpu.aovs.size(), embree.aovs.size());
  ASSERT_EQ(gpu.counters.size(), embree.counters.size());
  if (is_same) {
    EXPECT_EQ(gpu.radiance.pixels, embree.radiance.pixels);
    EXPECT_EQ(gpu.counters, embree.counters);
  }
  for (std::size_t i = 0; i < gpu.aovs.size(); ++i) {
    EXPECT_EQ(gpu.aovs[i].name, embree.aovs[i].name);
    if (is_same) {
      EXPECT_EQ(gpu.aovs[i].image.pixels, embree.aovs[i].image.pixels) << gpu.aovs[i].name;
    }
  }
  for (const char* name : {"shadow_rays", "fragments"}) {
    const double expected = test::counter(embree, name);
    EXPECT_NEAR(test::counter(gpu, name), expected, kMostOtherwise * expected) << name;
  }
}

/// Equal bits give equal pictures and counters, to the bit; other bits nearly equal ones.
TEST(GpuVisibilityGl, PicturesAreEmbrees) {
  const Comparison bits = compare(still_life(), 75, 53);
  EXPECT_LE(static_cast<double>(bits.differing), kMostDiffering * static_cast<double>(bits.rays))
      << bits.list;
  for (const Method& method : kMethods) {
    const Frame embree = picture(method, "embree");
    const Frame gpu = picture(method, "gpu");
    EXPECT_EQ(embree.device, "cpu");
    EXPECT_NE(gpu.device, "cpu");
    EXPECT_FALSE(gpu.gl_platform.empty());
    EXPECT_LT(test::relative_rmse(gpu.radiance, embree.radiance), 1e-3) << method.renderer;
    SCOPED_TRACE(method.renderer);
    expect_alike(gpu, embree, bits.differing == 0);
  }
}

/// What the device takes is told apart: the tree, lists up, rays, bits down.
TEST(GpuVisibilityGl, StagesNameTheDevicesPart) {
  StageTimer timer;
  picture(kMethods.front(), "gpu", &timer);
  for (const char* path :
       {"build/gpu_bvh", "build/gpu_bvh/upload", "visibility/upload", "visibility/rays",
        "visibility/download", "gather/irradiance/rays", "gather/shade/rays"}) {
    EXPECT_GT(timer.wall_of(path), 0.0) << path;
  }
  StageTimer embree;
  picture(kMethods.front(), "embree", &embree);
  EXPECT_GT(embree.wall_of("visibility/rays"), 0.0);
  EXPECT_GT(embree.wall_of("gather/irradiance/rays"), 0.0);
  EXPECT_EQ(embree.wall_of("visibility/upload"), 0.0);
  EXPECT_EQ(embree.wall_of("build/gpu_bvh"), 0.0);
}

TEST(GpuVisibilityGl, ASceneWithoutTrianglesIsDark) {
  scene::Scene scene;
  scene.camera = still_life().camera;
  for (const Method& method : kMethods) {
    test::RenderRequest request{.renderer = method.renderer, .settings = method.settings};
    request.settings.emplace_back("backend=gpu");
    EXPECT_EQ(test::mean_of(test::render(scene, request).radiance), 0.0) << method.renderer;
  }
}

std::unique_ptr<Renderer> renderer_on(const std::string& platform, const std::string& backend) {
  Devices devices;
  devices.platform = platform;
  return find_renderer("multires-shadows", {})
      .create(test::parameters_of("multires-shadows", {"backend=" + backend}), devices);
}

bool has_hardware() { return opengl::Context::hardware_of({}) != nullptr; }

TEST(GpuVisibilityGl, ADeviceThatIsMissingIsSaidAndAutoDoesWithoutIt) {
  if (has_hardware()) GTEST_SKIP() << "there is hardware";
  const scene::Scene scene = still_life();
  StageTimer timer;
  EXPECT_THROW(renderer_on("egl-device", "gpu")->prepare(scene, timer), UnsupportedError);
  RenderJob job;
  job.width_px = job.height_px = 8;
  job.camera = scene.camera;
  for (const char* platform : {"auto", "egl-device", "egl-surfaceless", "osmesa"}) {
    const auto renderer = renderer_on(platform, "auto");
    renderer->prepare(scene, timer);
    EXPECT_EQ(renderer->render(job, timer).device, "cpu") << platform;
  }
  const auto renderer = renderer_on("osmesa", "gpu");
  renderer->prepare(scene, timer);
  EXPECT_EQ(renderer->render(job, timer).gl_platform, "osmesa");
}

TEST(GpuVisibilityGl, AnUnknownBackendIsRefused) {
  for (const Method& method : kMethods) {
    EXPECT_EQ(
        tests::input_error_of([&] { test::parameters_of(method.renderer, {"backend=cpu"}); }),
        fmt::format("test: parameter \"backend\" of {} cannot be \"cpu\"; accepted: one of auto, "
                    "embree, gpu",
                    method.renderer));
  }
}

/// A scene that changes, a camera that moves: the device holds the newest state.
TEST(GpuVisibilityGl, FramesFollowTheScene) {
  scene::Scene scene = still_life();
  const auto gpu = renderer_on("auto", "gpu");
  const auto embree = renderer_on("auto", "embree");
  StageTimer timer;
  RenderJob job;
  job.width_px = 48;
  job.height_px = 32;
  job.camera = scene.camera;
  std::vector<float> before;
  for (int frame = 0; frame < 3; ++frame) {
    scene.objects[4].to_world[3] += glm::vec4(-0.15F, 0.05F, -0.1F, 0.0F);
    job.camera.position.x += 0.05F;
    for (Renderer* renderer : {gpu.get(), embree.get()}) {
      frame == 0 ? renderer->prepare(scene, timer) : renderer->update(scene, timer);
    }
    const Frame picture = gpu->render(job, timer);
    EXPECT_LT(test::relative_rmse(picture.radiance, embree->render(job, timer).radiance), 1e-3);
    EXPECT_NE(picture.radiance.pixels, before);
    before = picture.radiance.pixels;
  }
}

}  // namespace
}  // namespace renderers::area_shadows
