#include "renderers/ray_bundles/gpu_line_tracer.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "perception/base/errors.h"
#include "renderers/ray_bundles/direction_set.h"
#include "renderers/ray_bundles/gpu_bundle_lists.h"
#include "renderers/texel_atlas/world_triangles.h"
#include "tests/places.h"
#include "tests/renderers/opengl/platform_test.h"
#include "tests/renderers/ray_bundles/bundle_fixture.h"
#include "tests/temporary_folder.h"

/// Lists by rays on the device against those by Embree.
namespace renderers::ray_bundles {
namespace {

using test::BundleScene;
using test::SceneBuilder;

class GpuLineTracerTest : public opengl::PlatformTest {};
INSTANTIATE_TEST_SUITE_P(Platforms, GpuLineTracerTest, opengl::all_platforms(),
                         opengl::platform_label);

/// Sheets above each other, every one of them twice in the same object: duplicates.
SceneBuilder doubled_sheets(int sheets) {
  SceneBuilder builder;
  const int wall = builder.add_material(test::lambert(glm::vec3(0.5F)));
  for (int i = 0; i < sheets; ++i) {
    builder.add_quad({-1.0F, 0.1F * static_cast<float>(i), -1.0F}, {2, 0, 0}, {0, 0, 2}, wall);
    scene::Object& doubled = builder.scene.objects.back();
    scene::Mesh twice = *doubled.mesh;
    twice.triangles.insert(twice.triangles.end(), doubled.mesh->triangles.begin(),
                           doubled.mesh->triangles.end());
    doubled.mesh = std::make_shared<const scene::Mesh>(std::move(twice));
  }
  return builder;
}

/// A scene with lines traced by both.
struct Tracers {
  Tracers(const scene::Scene& scene, const std::shared_ptr<opengl::Context>& context,
          int atlas_side_px = 128, std::int64_t most_block_bytes = 0)
      : built(scene, atlas_side_px),
        world(texel_atlas::world_triangles(scene)),
        gpu(context, world, built.atlas, most_block_bytes),
        tracer(gpu.use_rays(world, built.atlas, built.timer)) {}

  BundleFrame frame(std::int64_t index, int lines) const {
    return {built.box, DirectionSet(DirectionKind::iid, 4, 0).at(index), lines};
  }

  BundleScene built;
  texel_atlas::WorldTriangles world;
  GpuBundleLists gpu;
  GpuLineTracer& tracer;
  BundleLists by_cpu;
  BundleLists by_gpu;
};

struct Difference {
  std::size_t lines = 0;
  std::size_t different = 0;  ///< in number, depth, side or object of their crossings
  std::size_t nodes = 0;
  std::size_t other_texels = 0;  ///< of lines alike, crossings in another texel
};

void add_difference(const BundleScene& built, const BundleLists& a, const BundleLists& b,
                    Difference& sum) {
  const auto& texels = built.atlas.texels();
  const auto is_same = [&](const ListNode& x, const ListNode& y) {
    return std::fabs(x.depth_m - y.depth_m) < 1e-4F && ((x.near_side ^ y.near_side) & 1U) == 0 &&
           texels[texel_of(x)].point.object == texels[texel_of(y)].point.object;
  };
  ASSERT_EQ(a.width_px(), b.width_px());
  ASSERT_EQ(a.height_px(), b.height_px());
  for (int y = 0; y < a.height_px(); ++y) {
    for (int x = 0; x < a.width_px(); ++x) {
      const auto line = a.line(x, y);
      const auto other = b.line(x, y);
      ++sum.lines;
      sum.nodes += line.size();
      if (!std::ranges::equal(line, other, is_same)) {
        ++sum.different;
        continue;
      }
      for (std::size_t i = 0; i < line.size(); ++i) {
        sum.other_texels += line[i].near_side != other[i].near_side ? 1 : 0;
      }
    }
  }
}

void expect_same_bits(const BundleLists& a, const BundleLists& b) {
  ASSERT_EQ(a.node_count(), b.node_count());
  for (int y = 0; y < a.height_px(); ++y) {
    for (int x = 0; x < a.width_px(); ++x) {
      EXPECT_TRUE(std::ranges::equal(a.line(x, y), b.line(x, y),
                                     [](auto& node, auto& other) {
                                       return node.depth_m == other.depth_m &&
                                              node.near_side == other.near_side;
                                     }))
          << x << " " << y;
    }
  }
}

TEST_P(GpuLineTracerTest, ListsAreEmbrees) {
  const SceneBuilder builder = test::closed_room();
  Tracers both(builder.scene, context_, 512);
  Difference sum;
  for (std::int64_t i = 0; i < 4; ++i) {
    const BundleFrame frame = both.frame(i, 512);
    trace_lists(both.built.rays, both.built.atlas, frame, both.by_cpu);
    const SlotCounts counts = both.gpu.fill(frame, both.by_gpu, both.built.timer);
    EXPECT_EQ(counts.passes, 2U);
    EXPECT_EQ(counts.dropped, 0U);
    add_difference(both.built, both.by_cpu, both.by_gpu, sum);
  }
  EXPECT_GT(sum.lines, 700'000U);
  EXPECT_GT(sum.nodes, sum.lines);
  EXPECT_LE(sum.different, sum.lines / 100'000) << "the stated share";
  EXPECT_LE(sum.other_texels, sum.nodes / 10'000);
  EXPECT_GT(both.built.timer.wall_of("trace"), 0.0);
}

/// What the share has to tell apart: lines a hundredth of a pixel away.
TEST_P(GpuLineTracerTest, OtherLinesAreOthers) {
  const SceneBuilder builder = test::closed_room();
  Tracers both(builder.scene, context_, 512);
  const BundleFrame frame = both.frame(0, 512);
  BundleFrame beside = frame;
  beside.corner += 0.01F * frame.pixel_m * frame.axis_x;
  trace_lists(both.built.rays, both.built.atlas, frame, both.by_cpu);
  both.gpu.fill(beside, both.by_gpu, both.built.timer);
  Difference sum;
  add_difference(both.built, both.by_cpu, both.by_gpu, sum);
  EXPECT_GT(sum.different, sum.lines / 10'000);
  EXPECT_GT(sum.other_texels, sum.nodes / 10'000);
}

/// Walks that are interrupted, after as little as a box, go on where they were.
TEST_P(GpuLineTracerTest, InterruptionsChangeNothing) {
  const SceneBuilder builder = test::closed_room();
  Tracers whole(builder.scene, context_);
  Tracers parts(builder.scene, context_);
  const BundleFrame frame = whole.frame(1, 96);
  whole.gpu.fill(frame, whole.by_gpu, whole.built.timer);
  for (const std::uint32_t boxes : {7U, 100U}) {
    parts.tracer.limit_boxes(boxes);
    parts.gpu.fill(frame, parts.by_gpu, parts.built.timer);
    expect_same_bits(whole.by_gpu, parts.by_gpu);
  }
}

TEST_P(GpuLineTracerTest, SmallBlocksChangeNothing) {
  const SceneBuilder builder = doubled_sheets(40);
  Tracers whole(builder.scene, context_, 64);
  constexpr std::int64_t kBlockBytes = 36'000;
  Tracers rows(builder.scene, context_, 64, kBlockBytes);
  const BundleFrame frame = whole.frame(2, 160);
  whole.gpu.fill(frame, whole.by_gpu, whole.built.timer);
  EXPECT_GT(whole.by_gpu.node_count() * sizeof(ListNode),
            4U * static_cast<std::size_t>(kBlockBytes));
  rows.gpu.fill(frame, rows.by_gpu, rows.built.timer);
  expect_same_bits(whole.by_gpu, rows.by_gpu);
  EXPECT_THROW(rows.gpu.keep(frame, nullptr, rows.built.timer), UnsupportedError);
}

/// A crossing that is found twice stands in the list once. Lists longer than what is sorted by
/// insertion.
TEST_P(GpuLineTracerTest, DuplicatesAreTakenOut) {
  constexpr int kSheets = 40;
  const SceneBuilder builder = doubled_sheets(kSheets);
  Tracers both(builder.scene, context_);
  const BundleFrame frame(both.built.box, {{0.02F, 0.9998F, 0.0F}, 0.3F, glm::vec2(0.4F)}, 96);
  both.gpu.fill(frame, both.by_gpu, both.built.timer);
  const auto line = both.by_gpu.line(frame.width_px / 2, frame.height_px / 2);
  EXPECT_EQ(line.size(), static_cast<std::size_t>(kSheets));
  EXPECT_TRUE(std::ranges::is_sorted(line, {}, &ListNode::depth_m));
  trace_lists(both.built.rays, both.built.atlas, frame, both.by_cpu);
  Difference sum;
  add_difference(both.built, both.by_cpu, both.by_gpu, sum);
  EXPECT_LE(sum.different, sum.lines / 1000);
}

/// Needles whose boxes all lie on the line, and after them a sheet: more turns of a loop than
/// Mesa's software driver allows an invocation.
TEST_P(GpuLineTracerTest, LongWaysComeToTheirEnd) {
  std::vector<gpu_tracing::BvhTriangle> triangles;
  constexpr std::uint32_t kNeedles = 90'000;
  for (std::uint32_t i = 0; i < kNeedles; ++i) {
    const glm::vec3 a(-1.0F + 1e-5F * static_cast<float>(i % 300),
                      -1.0F + 1e-5F * static_cast<float>(i / 300), -0.1F);
    triangles.push_back({a, 0, a + glm::vec3(2.0F, 2.0F, 0.2F), i, a + glm::vec3(1e-3F, 0, 0), 0});
  }
  triangles.push_back({{0, -1, 0.5F}, 0, {1, -1, 0.5F}, kNeedles, {0.5F, 1, 0.5F}, 0});
  StageTimer timer;
  GpuLineTracer tracer(context_, gpu_tracing::build_bvh(triangles), timer);
  // A single line, beside the needles and inside their boxes.
  BundleFrame frame({glm::vec3(-1.0F), glm::vec3(1.0F)}, {{0, 0, 1}, 0.0F, glm::vec2(0.0F)}, 4);
  frame.corner =
      glm::vec3(0.5F, -0.5F, -1.0F) - 0.5F * frame.pixel_m * (frame.axis_x + frame.axis_y);
  frame.width_px = 1;
  frame.height_px = 1;
  opengl::Buffer counts(context_, sizeof(std::uint32_t));
  counts.fill(0);
  tracer.count(frame, {0, 1}, counts);
  EXPECT_EQ(counts.read<std::uint32_t>(1).front(), 1U);
}

TEST_P(GpuLineTracerTest, EmptySpaceHasEmptyLists) {
  SceneBuilder builder;
  const int wall = builder.add_material(test::lambert(glm::vec3(0.5F)));
  builder.add_quad({-1, 0, -1}, {0.1F, 0, 0}, {0, 0, 0.1F}, wall);
  builder.add_quad({1, 1, 1}, {0.1F, 0, 0}, {0, 0, 0.1F}, wall);
  Tracers both(builder.scene, context_);
  const BundleFrame frame(both.built.box, {{0.0F, 0.0F, 1.0F}, 0.0F, glm::vec2(0.3F)}, 32);
  both.gpu.fill(frame, both.by_gpu, both.built.timer);
  EXPECT_EQ(both.by_gpu.node_count(), 0U);
}

/// The shaders of the bundles in a folder of their own, for DISCERN_SHADERS.
class ShaderCopies {
 public:
  ShaderCopies() {
    for (const char* kit : {"renderers/ray_bundles/shaders", "renderers/gpu_tracing/shaders"}) {
      std::filesystem::create_directories((folder_.path() / kit).parent_path());
      std::filesystem::copy(std::filesystem::path(tests::kSourceFolder) / kit,
                            folder_.path() / kit);
    }
    setenv("DISCERN_SHADERS", folder_.path().c_str(), 1);
  }
  ~ShaderCopies() { unsetenv("DISCERN_SHADERS"); }
  ShaderCopies(const ShaderCopies&) = delete;
  ShaderCopies& operator=(const ShaderCopies&) = delete;

  void replace(const std::string& shader, const std::string& text, const std::string& by) const {
    const std::filesystem::path path = folder_.path() / "renderers/ray_bundles/shaders" / shader;
    std::ifstream in(path);
    std::string all{std::istreambuf_iterator<char>(in), {}};
    const std::size_t at = all.find(text);
    ASSERT_NE(at, std::string::npos) << shader;
    std::ofstream(path) << all.replace(at, text.size(), by);
  }

 private:
  tests::TemporaryFolder folder_;
};

/// What goes wrong if counting and filling differ on the bundle (0, 0, 1) of 32 lines.
std::string fault_of(Tracers& tracers) {
  const BundleFrame frame(tracers.built.box, {{0.0F, 0.0F, 1.0F}, 0.0F, glm::vec2(0.3F)}, 32);
  try {
    tracers.gpu.fill(frame, tracers.by_gpu, tracers.built.timer);
  } catch (const base::DeviceError& error) {
    return error.what();
  }
  return "no error";
}

/// A shader that counts twice what it fills, and one that counts half.
TEST_P(GpuLineTracerTest, SaysThatCountsAndListsDiffer) {
  SceneBuilder builder;
  const int wall = builder.add_material(test::lambert(glm::vec3(0.5F)));
  builder.add_quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, wall);
  Tracers right(builder.scene, context_);
  EXPECT_EQ(fault_of(right), "no error");
  for (const char* by : {"count += 2u;", ";"}) {
    const ShaderCopies shaders;
    shaders.replace("trace_lines.comp.glsl", "++count;", by);
    Tracers wrong(builder.scene, opengl::Context::create(GetParam()));
    EXPECT_NE(fault_of(wrong).find(" lines differently; accepted: "), std::string::npos)
        << by << fault_of(wrong);
  }
}

}  // namespace
}  // namespace renderers::ray_bundles
