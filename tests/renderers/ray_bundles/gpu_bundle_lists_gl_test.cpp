#include "renderers/ray_bundles/gpu_bundle_lists.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "renderers/ray_bundles/bundle_raster.h"
#include "renderers/ray_bundles/direction_set.h"
#include "renderers/ray_bundles/gpu_dispatch.h"
#include "renderers/texel_atlas/world_triangles.h"
#include "tests/renderers/opengl/platform_test.h"
#include "tests/renderers/ray_bundles/bundle_fixture.h"

/// Lists by the device's rasteriser against those of the CPU's, which brute force has tested.
namespace renderers::ray_bundles {
namespace {

using test::BundleScene;
using test::SceneBuilder;

class GpuBundleListsTest : public opengl::PlatformTest {};
INSTANTIATE_TEST_SUITE_P(Platforms, GpuBundleListsTest, opengl::all_platforms(),
                         opengl::platform_label);

/// Boards above each other in a closed room: a line along y crosses 2 boards + 2 surfaces.
SceneBuilder shelves(int boards) {
  SceneBuilder builder;
  const int wall = builder.add_material(test::lambert(glm::vec3(0.5F)));
  const float height = static_cast<float>(boards);
  builder.add_box({-2.0F, 0.0F, -2.0F}, {2.0F, height + 1.0F, 2.0F}, wall, true);
  for (int i = 0; i < boards; ++i) {
    const float low = 0.5F + static_cast<float>(i);
    builder.add_box({-1.0F, low, -0.8F}, {0.9F, low + 0.3F, 0.7F}, wall, false);
  }
  return builder;
}

struct Difference {
  std::size_t lines = 0;
  std::size_t different = 0;    ///< in number, depth, side or object of their crossings
  std::size_t unexplained = 0;  ///< of them, no edge of a triangle passes by
  std::size_t nodes = 0;
  std::size_t other_texels = 0;  ///< of lines alike, crossings in another texel

  void add(const Difference& other) {
    lines += other.lines;
    different += other.different;
    unexplained += other.unexplained;
    nodes += other.nodes;
    other_texels += other.other_texels;
  }
};

/// OpenGL drivers round corners to 1/256 pixel or better, to whichever side.
constexpr double kEdgePasses_px = 1.0 / 128.0;

double distance_px(const glm::dvec2& point, const glm::dvec2& from, const glm::dvec2& to) {
  const glm::dvec2 along = to - from;
  const double length2 = glm::dot(along, along);
  const double share = length2 > 0.0 ? glm::dot(point - from, along) / length2 : 0.0;
  return glm::distance(point, from + std::clamp(share, 0.0, 1.0) * along);
}

/// True if the centre of a pixel lies beside an edge of a triangle.
bool is_beside_edge(const texel_atlas::WorldTriangles& world, const BundleFrame& frame, int x,
                    int y) {
  const glm::dvec2 center(x + 0.5, y + 0.5);
  const auto place = [&](const glm::dvec3& corner) {
    const glm::dvec3 offset = corner - glm::dvec3(frame.corner);
    return glm::dvec2(glm::dot(offset, glm::dvec3(frame.axis_x)),
                      glm::dot(offset, glm::dvec3(frame.axis_y))) /
           static_cast<double>(frame.pixel_m);
  };
  return std::ranges::any_of(world.triangles, [&](const texel_atlas::WorldTriangle& triangle) {
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec2 from = place(triangle.corners[i]);
      const glm::dvec2 to = place(triangle.corners[(i + 1) % 3]);
      if (distance_px(center, from, to) < kEdgePasses_px) return true;
    }
    return false;
  });
}

/// A scene with both rasterisers.
struct Builders {
  Builders(const scene::Scene& scene, const std::shared_ptr<opengl::Context>& context,
           int atlas_side_px = 128, std::int64_t most_block_bytes = 0)
      : built(scene, atlas_side_px),
        world(texel_atlas::world_triangles(scene)),
        cpu(world, built.atlas),
        gpu(context, world, built.atlas, most_block_bytes) {}
  BundleScene built;
  texel_atlas::WorldTriangles world;
  BundleRaster cpu;
  GpuBundleLists gpu;
  BundleLists by_cpu;
  BundleLists by_gpu;
};

/// Of the last lists of both.
Difference difference(const Builders& both, const BundleFrame& frame) {
  const auto& texels = both.built.atlas.texels();
  Difference result;
  for (int y = 0; y < frame.height_px; ++y) {
    for (int x = 0; x < frame.width_px; ++x) {
      const auto line = both.by_cpu.line(x, y);
      const auto other = both.by_gpu.line(x, y);
      bool is_same = line.size() == other.size();
      std::size_t elsewhere = 0;
      for (std::size_t i = 0; is_same && i < line.size(); ++i) {
        is_same = std::fabs(line[i].depth_m - other[i].depth_m) < 1e-4F &&
                  ((line[i].near_side ^ other[i].near_side) & 1U) == 0 &&
                  texels[texel_of(line[i])].point.object == texels[texel_of(other[i])].point.object;
        elsewhere += line[i].near_side != other[i].near_side ? 1 : 0;
      }
      ++result.lines;
      result.nodes += line.size();
      if (is_same) {
        result.other_texels += elsewhere;
      } else {
        ++result.different;
        result.unexplained += is_beside_edge(both.world, frame, x, y) ? 0 : 1;
      }
    }
  }
  return result;
}

void expect_same_bits(const BundleFrame& frame, const BundleLists& a, const BundleLists& b) {
  ASSERT_EQ(a.node_count(), b.node_count());
  for (int y = 0; y < frame.height_px; ++y) {
    for (int x = 0; x < frame.width_px; ++x) {
      const auto line = a.line(x, y);
      const auto other = b.line(x, y);
      ASSERT_EQ(line.size(), other.size()) << x << " " << y;
      for (std::size_t i = 0; i < line.size(); ++i) {
        ASSERT_EQ(line[i].depth_m, other[i].depth_m);
        ASSERT_EQ(line[i].near_side, other[i].near_side);
      }
    }
  }
}

TEST_P(GpuBundleListsTest, AreThoseOfTheCpu) {
  const SceneBuilder builder = test::closed_room();
  Builders both(builder.scene, context_, 512);
  DirectionSet set(DirectionKind::iid, 4, 0);
  Difference sum;
  for (std::int64_t i = 0; i < 6; ++i) {
    const BundleFrame frame(both.built.box, set.at(i), 512);
    both.cpu.fill(frame, both.by_cpu);
    const SlotCounts counts = both.gpu.fill(frame, both.by_gpu, both.built.timer);
    EXPECT_EQ(counts.passes, 2U);
    EXPECT_EQ(counts.dropped, 0U);
    sum.add(difference(both, frame));
  }
  EXPECT_GT(sum.lines, 1'000'000U);
  EXPECT_GT(sum.nodes, sum.lines);
  EXPECT_LE(sum.different, sum.lines / 10'000) << "the stated share";
  EXPECT_EQ(sum.unexplained, 0U);
  EXPECT_LE(sum.other_texels, sum.nodes / 10'000);
}

/// Hermes et al. 2010, Sec. 4.2: what is drawn first stays, in any number of passes.
TEST_P(GpuBundleListsTest, SlotsAreThoseOfTheCpu) {
  const SceneBuilder builder = shelves(11);
  Builders both(builder.scene, context_);
  DirectionSet set(DirectionKind::iid, 5, 0);
  // Upright, no edge within 1/256 pixel of a centre: every count is the CPU's.
  std::vector<BundleDirection> directions{{{0.0F, 1.0F, 0.0F}, 0.0F, glm::vec2(0.37F, 0.21F)}};
  for (std::int64_t i = 0; i < 3; ++i) directions.push_back(set.at(i));
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const BundleFrame frame(both.built.box, directions[i], 128);
    both.gpu.fill(frame, both.by_gpu, both.built.timer);
    BundleLists counted;
    both.gpu.fill(frame, counted, both.built.timer);
    if (i == 0) {
      EXPECT_EQ(both.by_gpu.line(frame.width_px / 2, frame.height_px / 2).size(), 24U);
    }
    for (const int k : {1, 4, 8, 24, 30}) {
      for (const bool until_complete : {false, true}) {
        const SlotSettings settings{k, until_complete};
        const SlotCounts expected = both.cpu.fill_slots(frame, settings, both.by_cpu);
        const SlotCounts found =
            both.gpu.fill_slots(frame, settings, both.by_gpu, both.built.timer);
        EXPECT_EQ(found.passes, expected.passes) << k;
        if (i == 0) {
          EXPECT_EQ(found.dropped, expected.dropped) << k;
          EXPECT_EQ(found.dropped > 0, !until_complete && k < 24);
        } else {
          EXPECT_NEAR(static_cast<double>(found.dropped), static_cast<double>(expected.dropped),
                      1e-3 * static_cast<double>(expected.dropped));
        }
        const Difference lists = difference(both, frame);
        EXPECT_EQ(lists.unexplained, 0U) << k;
        EXPECT_LE(lists.different, lists.lines / 1000) << k;
        if (until_complete) expect_same_bits(frame, counted, both.by_gpu);
      }
    }
  }
}

/// The second pass of a line that has 3 crossings and 2 slots, and was drawn 6 times in all.
TEST_P(GpuBundleListsTest, SlotsOfAnotherDrawingAreFaults) {
  constexpr std::uint32_t kFree = 0xffffffffU;
  const auto faults = [&](std::uint32_t drawn, const std::vector<std::uint32_t>& slots) {
    const auto words = [&](const std::vector<std::uint32_t>& values) {
      return opengl::Buffer::of<std::uint32_t>(context_, values);
    };
    const auto counts = words({drawn});
    const auto starts = words({0, 3});
    const auto list = words({1, 2, 0});
    const auto filled = words(slots);
    const auto first_words = words({3});
    const auto found = words({0});
    opengl::Program& program = compute_program(*context_, "take_slots");
    const std::pair<std::uint32_t, const opengl::Buffer*> buffers[] = {
        {2, &counts}, {3, &starts}, {4, &list}, {8, &filled}, {9, &first_words}, {10, &found}};
    for (const auto& [binding, buffer] : buffers) program.storage(binding, *buffer);
    program.set("line_count", 1U);
    program.set("slot_count", 2U);
    program.set("pass", 1U);
    program.set("until_complete", 1);
    dispatch_items(program, 1);
    EXPECT_NE(list.read<std::uint32_t>(3).back(), kFree);
    return found.read<std::uint32_t>(1).front();
  };
  EXPECT_EQ(faults(6, {5, kFree}), 0U);
  EXPECT_EQ(faults(5, {kFree, kFree}), 1U) << "one fewer";
  EXPECT_EQ(faults(7, {5, 6}), 1U) << "one more";
  EXPECT_EQ(faults(6, {kFree, kFree}), 1U) << "another one";
}

/// Lists longer than what is sorted by insertion.
TEST_P(GpuBundleListsTest, LongListsAreInOrder) {
  const SceneBuilder builder = shelves(60);
  Builders both(builder.scene, context_);
  const BundleFrame frame(both.built.box, {{0.02F, 0.9998F, 0.0F}, 0.3F, glm::vec2(0.4F)}, 96);
  both.cpu.fill(frame, both.by_cpu);
  both.gpu.fill(frame, both.by_gpu, both.built.timer);
  const Difference lists = difference(both, frame);
  EXPECT_EQ(lists.unexplained, 0U);
  std::size_t longest = 0;
  for (int y = 0; y < frame.height_px; ++y) {
    for (int x = 0; x < frame.width_px; ++x) {
      const auto line = both.by_gpu.line(x, y);
      longest = std::max(longest, line.size());
      EXPECT_TRUE(std::ranges::is_sorted(line, {}, &ListNode::depth_m));
    }
  }
  EXPECT_GE(longest, 120U);
}

/// More surfaces behind each other than a software driver can order: an error, or the CPU's lists.
TEST_P(GpuBundleListsTest, TooLongListsAreRefused) {
  SceneBuilder builder;
  const int wall = builder.add_material(test::lambert(glm::vec3(0.5F)));
  constexpr int kSheets = 6000;
  for (int i = 0; i < kSheets; ++i) {
    const float z = static_cast<float>((i * 7919) % kSheets) / kSheets;
    builder.add_quad({-1, -1, z}, {2, 0, 0}, {0, 2, 0}, wall);
  }
  Builders both(builder.scene, context_, 512);
  const BundleFrame frame(both.built.box, {{0.0F, 0.0F, 1.0F}, 0.3F, glm::vec2(0.4F)}, 8);
  both.cpu.fill(frame, both.by_cpu);
  try {
    both.gpu.fill(frame, both.by_gpu, both.built.timer);
    EXPECT_FALSE(context_->is_software());
    EXPECT_EQ(both.by_gpu.node_count(), both.by_cpu.node_count());
  } catch (const UnsupportedError& error) {
    EXPECT_NE(std::string(error.what()).find("are in order; accepted: backend cpu"),
              std::string::npos)
        << error.what();
  }
}

/// What storage blocks cannot hold at once is made in rows: the same lists, to the bit.
TEST_P(GpuBundleListsTest, SmallBlocksChangeNothing) {
  const SceneBuilder builder = shelves(11);
  Builders whole(builder.scene, context_, 64);
  constexpr std::int64_t kBlockBytes = 36'000;
  Builders rows(builder.scene, context_, 64, kBlockBytes);
  DirectionSet set(DirectionKind::iid, 6, 0);
  for (std::int64_t i = 0; i < 3; ++i) {
    const BundleFrame frame(whole.built.box, set.at(i), 160);
    whole.gpu.fill(frame, whole.by_gpu, whole.built.timer);
    EXPECT_GT(whole.by_gpu.node_count() * sizeof(ListNode),
              4U * static_cast<std::size_t>(kBlockBytes));
    rows.gpu.fill(frame, rows.by_gpu, rows.built.timer);
    expect_same_bits(frame, whole.by_gpu, rows.by_gpu);
    const SlotCounts expected =
        whole.gpu.fill_slots(frame, {4, false}, whole.by_gpu, whole.built.timer);
    const SlotCounts found = rows.gpu.fill_slots(frame, {4, false}, rows.by_gpu, rows.built.timer);
    EXPECT_EQ(found.dropped, expected.dropped);
    expect_same_bits(frame, whole.by_gpu, rows.by_gpu);
  }
}

TEST_P(GpuBundleListsTest, RefusesWhatNoBlockHolds) {
  const SceneBuilder builder = shelves(11);
  const auto message = [&](std::int64_t most_block_bytes, int lines) {
    try {
      Builders both(builder.scene, context_, 32, most_block_bytes);
      const BundleFrame frame(both.built.box, {{0.0F, 1.0F, 0.0F}, 0.0F, glm::vec2(0.0F)}, lines);
      both.gpu.fill(frame, both.by_gpu, both.built.timer);
    } catch (const UnsupportedError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(message(5000, 32).find("144 triangles take 11520 bytes"), std::string::npos)
      << message(5000, 32);
  EXPECT_NE(message(12'000, 1200).find("crossings of"), std::string::npos) << message(12'000, 1200);
  EXPECT_NE(message(12'000, 1200).find("allows a storage block 12000"), std::string::npos);
  EXPECT_NE(message(12'000, 16'000).find("bytes of a row of lines"), std::string::npos)
      << message(12'000, 16'000);
  EXPECT_EQ(message(0, 400), "no error");
}

/// What `backend: auto` asks before it takes a device.
TEST_P(GpuBundleListsTest, SaysWhichBlockASceneTakes) {
  const SceneBuilder builder = shelves(11);
  for (const int atlas_side_px : {32, 128}) {
    const BundleScene built(builder.scene, atlas_side_px);
    const std::int64_t bytes =
        GpuBundleLists::scene_block_bytes(built.rays.triangle_count(), built.atlas);
    EXPECT_GE(bytes, std::int64_t{4} * atlas_side_px * atlas_side_px);
    EXPECT_NO_THROW(Builders(builder.scene, context_, atlas_side_px, bytes));
    EXPECT_THROW(Builders(builder.scene, context_, atlas_side_px, bytes - 1), UnsupportedError);
  }
}

/// Coincident sheets back to back, of two objects and of one, as `order_nodes` has them.
TEST_P(GpuBundleListsTest, TiesAreTheCpus) {
  SceneBuilder builder;
  const int wall = builder.add_material(test::lambert(glm::vec3(0.5F)));
  builder.add_quad({-1, -1, 0.3F}, {2, 0, 0}, {0, 2, 0}, wall);
  builder.add_quad({-1, -1, 0.3F}, {0, 2, 0}, {2, 0, 0}, wall);
  builder.add_quad({-1, -1, 0.3F}, {2, 0, 0}, {0, 2, 0}, wall);
  // Of one object a second sheet that looks the same way is a duplicate.
  scene::Object& doubled = builder.scene.objects.back();
  scene::Mesh twice = *doubled.mesh;
  twice.triangles.insert(twice.triangles.end(), doubled.mesh->triangles.begin(),
                         doubled.mesh->triangles.end());
  doubled.mesh = std::make_shared<const scene::Mesh>(std::move(twice));
  builder.add_box(glm::vec3(-1.5F), glm::vec3(1.5F), wall, true);
  Builders both(builder.scene, context_);
  DirectionSet set(DirectionKind::iid, 8, 0);
  Difference sum;
  for (std::int64_t i = 0; i < 8; ++i) {
    const BundleFrame frame(both.built.box, set.at(i), 96);
    both.cpu.fill(frame, both.by_cpu);
    both.gpu.fill(frame, both.by_gpu, both.built.timer);
    sum.add(difference(both, frame));
  }
  EXPECT_EQ(sum.unexplained, 0U);
}

TEST_P(GpuBundleListsTest, AreTheSameEveryTime) {
  const SceneBuilder builder = test::closed_room();
  Builders both(builder.scene, context_);
  const BundleFrame frame(both.built.box, DirectionSet(DirectionKind::iid, 9, 0).at(0), 200);
  both.gpu.fill(frame, both.by_gpu, both.built.timer);
  for (int i = 0; i < 3; ++i) {
    BundleLists again;
    both.gpu.fill(frame, again, both.built.timer);
    expect_same_bits(frame, both.by_gpu, again);
  }
}

}  // namespace
}  // namespace renderers::ray_bundles
