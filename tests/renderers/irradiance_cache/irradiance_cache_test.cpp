#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "renderers/irradiance_cache/hemisphere_grid.h"
#include "renderers/irradiance_cache/irradiance_records.h"
#include "renderers/ray_tracing/sample_sequence.h"
#include "tests/expect_input_error.h"
#include "tests/renderers/element_hierarchy/hierarchy_fixture.h"
#include "tests/renderers/scene_builder.h"

/// Records, their gradients and what lies between them, against closed forms; then the renderer
/// against the path tracer.
namespace renderers::test {
namespace {

using indirect_view::ViewedPoint;
using irradiance_cache::IrradianceRecord;
using irradiance_cache::IrradianceRecords;

constexpr double kPi = 3.14159265358979;

/// A small floor, whose middle is the origin, under something else.
struct Floor {
  Floor() {
    builder.add_quad({-0.1F, 0, -0.1F}, {0, 0, 0.2F}, {0.2F, 0, 0},
                     builder.add_material(lambert(glm::vec3(0.5F))));
  }
  IrradianceRecord record(const indirect_view::RayRadiance& radiance, std::uint64_t seed = 1,
                          const glm::vec3& shading_normal = {0, 1, 0}) {
    StageTimer timer;
    const ray_tracing::RayScene rays(builder.scene, timer);
    ViewedPoint point =
        indirect_view::viewed_point(rays.point_on_triangle(0, 0, {0.5F, 0.0F}), {0, 1, 0}, seed, 0);
    point.surface.position = {0, 0, 0};
    point.normal = glm::normalize(shading_normal);
    std::uint64_t cast = 0;
    return sample_record(rays, point, irradiance_cache::grid_size(4096), {0.01F, 100.0F, false},
                         radiance, cast);
  }
  SceneBuilder builder;
};

/// Radiance 1 + x of the direction: E = pi at the top, and 2 pi / 3 per radian towards x.
TEST(IrradianceRecord, ATurnTowardsTheLightAddsItsMoment) {
  Floor floor;
  floor.builder.add_sphere({0, 0, 0}, 2.0F, 32, 0);
  const IrradianceRecord record = floor.record([](const ViewedPoint& seen, float) {
    return glm::vec3(1.0F + glm::normalize(seen.surface.position).x);
  });
  EXPECT_NEAR(static_cast<double>(record.irradiance.x), kPi, 0.01 * kPi);
  EXPECT_NEAR(static_cast<double>(record.radius_m), 2.0, 0.02);
  const glm::vec3 tilted(std::sin(0.1F), std::cos(0.1F), 0.0F);
  const double gain =
      static_cast<double>(glm::dot(glm::cross(record.normal, tilted), record.rotation[0]));
  EXPECT_NEAR(gain, std::sin(0.1) * 2.0 * kPi / 3.0, 0.02 * 0.2);
  EXPECT_NEAR(static_cast<double>(record.rotation[1].y), 0.0, 1e-3);
}

/// Under a ceiling at height 1 that shines where x > 0, E = pi (1 + x / sqrt(1 + x^2)) / 2: pi / 2
/// per metre along x, nothing along z.
TEST(IrradianceRecord, AStepTowardsTheLightAddsTheSlope) {
  Floor floor;
  floor.builder.add_quad({-200, 1, -200}, {400, 0, 0}, {0, 0, 400}, 0);
  glm::dvec3 gradient(0.0);
  constexpr int kRecords = 8;
  for (int i = 0; i < kRecords; ++i) {
    const IrradianceRecord record =
        floor.record([](const ViewedPoint& seen,
                        float) { return glm::vec3(seen.surface.position.x > 0.0F ? 1.0F : 0.0F); },
                     static_cast<std::uint64_t>(i));
    gradient += glm::dvec3(record.translation[2]) / static_cast<double>(kRecords);
  }
  EXPECT_NEAR(gradient.x, 0.5 * kPi, 0.05 * 0.5 * kPi);
  EXPECT_NEAR(gradient.z, 0.0, 0.03);
}

TEST(IrradianceRecord, InAFurnaceNothingChanges) {
  Floor floor;
  floor.builder.add_box({-1, -0.5F, -1}, {1, 1, 1}, 0, true);
  const IrradianceRecord record =
      floor.record([](const ViewedPoint&, float) { return glm::vec3(2.0F); });
  EXPECT_NEAR(static_cast<double>(record.irradiance.y), 2.0 * kPi, 1e-4);
  EXPECT_LT(glm::length(record.rotation[1]), 0.1F);  // of 2 pi per radian, by noise
  EXPECT_EQ(record.translation[1], glm::vec3(0.0F));
}

/// The numbers of this seed put a ray of the last row at 1 by rounding: its tangent was infinite.
TEST(IrradianceRecord, GradientsStayFiniteAtTheHorizon) {
  constexpr std::uint64_t kSeed = 9719;
  const irradiance_cache::GridSize size = irradiance_cache::grid_size(4096);
  ray_tracing::SampleSequence numbers(ray_tracing::SequenceKind::random, kSeed, 0);
  float greatest = 0.0F;
  for (int j = 0; j < size.polar; ++j) {
    for (int k = 0; k < size.azimuth; ++k) {
      const auto place = static_cast<float>(j) + numbers.next().x;
      greatest = std::max(greatest, place / static_cast<float>(size.polar));
    }
  }
  ASSERT_EQ(greatest, 1.0F);
  Floor floor;
  floor.builder.add_sphere({0, 0, 0}, 2.0F, 16, 0);
  // Tilted either way, so that the ray is above the triangle.
  for (const float tilt : {-0.3F, 0.3F}) {
    const IrradianceRecord record = floor.record(
        [](const ViewedPoint&, float) { return glm::vec3(1.0F); }, kSeed, {tilt, 1.0F, tilt});
    for (const glm::vec3& gradient : record.rotation) {
      EXPECT_TRUE(glm::all(glm::lessThan(glm::abs(gradient), glm::vec3(100.0F)))) << tilt;
    }
    EXPECT_GT(record.irradiance.x, 0.0F);
  }
}

IrradianceRecord flat_record(const glm::vec3& position, float radius_m) {
  IrradianceRecord record;
  record.position = position;
  record.normal = {0, 1, 0};
  record.irradiance = glm::vec3(1.0F);
  record.translation.fill({0.5F, 0, 0});
  record.radius_m = radius_m;
  return record;
}

TEST(IrradianceRecords, GradientsCarryTheIrradianceOn) {
  for (const bool gradients : {true, false}) {
    IrradianceRecords records({.accuracy = 0.5F, .gradients = gradients}, {-2, -2, -2}, {2, 2, 2});
    records.insert(flat_record({0, 0, 0}, 1.0F));
    const auto value = records.irradiance({0.2F, 0, 0}, {0, 1, 0});
    ASSERT_TRUE(value);
    EXPECT_NEAR(value->x, gradients ? 1.1F : 1.0F, 1e-5F);
    EXPECT_FALSE(records.irradiance({0.6F, 0, 0}, {0, 1, 0}));       // too far
    EXPECT_TRUE(records.irradiance({0.6F, 0, 0}, {0, 1, 0}, 2.0F));  // not if stretched
    EXPECT_FALSE(records.irradiance({0.1F, 0, 0}, {1, 0, 0}));       // faces another way
    EXPECT_FALSE(records.irradiance({0, -0.2F, 0}, {0, 1, 0}));      // behind the record
  }
}

TEST(IrradianceRecords, TheOctreeFindsAllInReach) {
  IrradianceRecords records({.accuracy = 0.3F, .gradients = false, .neighbour_clamp = false},
                            {-2, 0, -2}, {2, 0, 2});
  for (int i = 0; i < 40; ++i) {
    const auto f = static_cast<float>(i);
    IrradianceRecord record =
        flat_record({1.9F * std::sin(7.0F * f), 0, 1.9F * std::cos(3.0F * f)}, 0.1F + 0.05F * f);
    record.irradiance = glm::vec3(f);
    records.insert(record);
  }
  for (int i = 0; i < 100; ++i) {
    const glm::vec3 at(-1.8F + 0.4F * static_cast<float>(i % 10), 0.0F,
                       -1.8F + 0.4F * static_cast<float>(i / 10));
    float sum = 0.0F;
    float weights = 0.0F;
    for (const IrradianceRecord& record : records.records()) {
      const float error = std::fmax(1e-4F, glm::distance(at, record.position) / record.radius_m);
      if (error >= 0.3F) continue;
      sum += (1.0F / error - 1.0F / 0.3F) * record.irradiance.x;
      weights += 1.0F / error - 1.0F / 0.3F;
    }
    const auto value = records.irradiance(at, {0, 1, 0});
    ASSERT_EQ(value.has_value(), weights > 0.0F) << i;
    if (value) {
      EXPECT_NEAR(value->x, sum / weights, 1e-3F * (1.0F + sum / weights));
    }
  }
}

TEST(IrradianceRecords, RadiiOfNeighboursDifferByTheirDistance) {
  IrradianceRecords records({.accuracy = 0.5F}, {-2, -2, -2}, {2, 2, 2});
  records.insert(flat_record({0, 0, 0}, 2.0F));
  records.insert(flat_record({0.5F, 0, 0}, 0.1F));
  records.insert(flat_record({0, 0, 0.25F}, 2.0F));
  EXPECT_FLOAT_EQ(records.records()[0].radius_m, 0.6F);
  EXPECT_FLOAT_EQ(records.records()[2].radius_m, 0.85F);
}

Frame cache_of(const scene::Scene& scene, std::vector<std::string> settings, int threads = 0) {
  settings.emplace_back("part=indirect");
  return render(scene, {.renderer = "irradiance-cache",
                        .settings = settings,
                        .width_px = 16,
                        .height_px = 16,
                        .samples = 8,
                        .threads = threads});
}

TEST(IrradianceCache, AgreesWithThePathTracer) {
  const SceneBuilder builder = lit_room();
  const Frame truth = render(builder.scene, {.settings = {"transport=diffuse", "part=indirect"},
                                             .width_px = 16,
                                             .height_px = 16,
                                             .samples = 256});
  const Frame frame = cache_of(builder.scene, {"hemisphere_rays=256"});
  const double mean = mean_of(truth.radiance);
  EXPECT_NEAR(mean_of(frame.radiance), mean, 0.04 * mean);
}

/// With one surface behind a record's rays it is the path tracer's one bounce, and claims that.
TEST(IrradianceCache, ClaimsTheBouncesThatItFollows) {
  const SceneBuilder builder = lit_room();
  const RendererInfo& info = find_renderer("irradiance-cache", {});
  const auto transport = [&](const char* depth) {
    return info.claims(parameters_of("irradiance-cache", {depth}), builder.scene).transport;
  };
  EXPECT_EQ(transport("depth=0"), Transport::diffuse);
  EXPECT_EQ(transport("depth=1"), Transport::one_bounce);
  const auto truth = [&](const char* bounces) {
    const Frame frame = render(
        builder.scene,
        {.settings = {bounces, "part=indirect"}, .width_px = 16, .height_px = 16, .samples = 128});
    return mean_of(frame.radiance);
  };
  const double one_bounce = truth("transport=one_bounce");
  const Frame frame = cache_of(builder.scene, {"hemisphere_rays=256", "depth=1"});
  EXPECT_NEAR(mean_of(frame.radiance), one_bounce, 0.04 * one_bounce);
  EXPECT_GT(truth("transport=diffuse"), 1.2 * one_bounce);
}

/// A floor lit by a wall alone, whose light falls off quickly: gradients help coarse records, and
/// so do more records.
TEST(IrradianceCache, ErrorFallsWithGradientsAndWithAccuracy) {
  SceneBuilder builder;
  builder.add_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0},
                   builder.add_material(lambert(glm::vec3(0.8F))));
  builder.add_quad({-0.5F, 0.5F, 0}, {0, 1, 0}, {1, 0, 0},
                   builder.add_material(lambert(glm::vec3(0.9F))));
  builder.add_point_light({0, 1.0F, -2.0F}, glm::vec3(5.0F));
  builder.look({0, 3.0F, -1.2F}, {0, 0, -1.2F}, 45.0F);
  const Frame truth = render(builder.scene, {.settings = {"transport=diffuse", "part=indirect"},
                                             .width_px = 16,
                                             .height_px = 16,
                                             .samples = 512});
  const auto error_of = [&](const Frame& frame) {
    double sum = 0.0;
    for (std::size_t i = 0; i < frame.radiance.pixels.size(); ++i) {
      sum += std::pow(static_cast<double>(frame.radiance.pixels[i] - truth.radiance.pixels[i]), 2);
    }
    return sum;
  };
  const auto cache = [&](const char* accuracy, const char* gradients) {
    return cache_of(builder.scene, {accuracy, gradients, "hemisphere_rays=1000"});
  };
  const Frame fine = cache("accuracy=0.1", "gradients=true");
  const Frame coarse = cache("accuracy=0.6", "gradients=true");
  const Frame flat = cache("accuracy=0.6", "gradients=false");
  EXPECT_LT(error_of(coarse), 0.7 * error_of(flat));
  EXPECT_LT(error_of(fine), 0.7 * error_of(coarse));
  EXPECT_LT(counter(coarse, "records"), 0.5 * counter(fine, "records"));
}

TEST(IrradianceCache, SameBytesForEveryNumberOfThreads) {
  const SceneBuilder builder = lit_room();
  const std::vector<std::string> settings{"accuracy=0.5", "hemisphere_rays=32"};
  EXPECT_EQ(cache_of(builder.scene, settings, 1).radiance.pixels,
            cache_of(builder.scene, settings, 2).radiance.pixels);
}

TEST(IrradianceCacheSettings, RefusesSpacingsThatCross) {
  const RendererInfo& info = find_renderer("irradiance-cache", {});
  EXPECT_EQ(tests::input_error_of(
                [&] { info.create(parameters_of("irradiance-cache", {"least_spacing=0.5"}), {}); }),
            "irradiance-cache: least_spacing is 0.5; accepted: at most greatest_spacing, 0.25");
}

TEST(IrradianceCacheSettings, RefusesDepthsThatNoClaimDescribes) {
  EXPECT_EQ(
      tests::input_error_of([] { parameters_of("irradiance-cache", {"depth=2"}); }),
      "test: parameter \"depth\" of irradiance-cache cannot be \"2\"; accepted: a whole number "
      "from 0 to 1 (surfaces)");
}

}  // namespace
}  // namespace renderers::test
