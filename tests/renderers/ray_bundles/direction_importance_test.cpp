#include "renderers/ray_bundles/direction_importance.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "tests/renderers/ray_bundles/bundle_fixture.h"

/// Directions drawn by the light that bundles have to carry (Hermes et al. 2010, Sec. 7).
namespace renderers::test {
namespace {

using ray_bundles::BundleDirection;
using ray_bundles::DirectionImportance;
using ray_bundles::DirectionKind;
using ray_bundles::DirectionSet;

/// Five sixths of the weight within 25 degrees of +z, which the cells only show on one
/// side.
std::vector<double> weights_of_a_cap() {
  std::vector<double> weights(DirectionImportance::kCells, 0.01);
  for (std::size_t i = 0; i < DirectionImportance::kCells / 20; ++i) weights[i] = 1.0;
  return weights;
}

TEST(DirectionImportance, IsADensityOverLines) {
  const DirectionImportance importance(weights_of_a_cap());
  // Uniform points of the sphere: the density's integral, and both senses of a line.
  DirectionSet uniform(DirectionKind::fibonacci, 1, 20'000);
  double integral = 0.0;
  for (std::int64_t i = 0; i < 20'000; ++i) {
    const glm::vec3 w = uniform.at(i).direction;
    integral += 4.0 * std::numbers::pi * importance.density(w) / 20'000;
    EXPECT_NEAR(importance.density(-w), importance.density(w), 1e-9);
  }
  EXPECT_NEAR(integral, 1.0, 2e-3);
  EXPECT_TRUE(
      DirectionImportance(std::vector<double>(DirectionImportance::kCells, 0.0)).is_empty());
}

/// The share of drawn directions in a part of the sphere is the density's integral over it.
TEST(DirectionImportance, DrawsByItsDensity) {
  const DirectionImportance importance(weights_of_a_cap());
  DirectionSet points(DirectionKind::fibonacci, 2, 20'000);
  double near_pole = 0.0;
  double expected = 0.0;
  constexpr int kSide = 640;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const glm::dvec2 u((x + 0.5) / kSide, (y + 0.5) / kSide);
      const glm::vec3 drawn = importance.sample(u);
      EXPECT_NEAR(glm::length(drawn), 1.0F, 1e-5F);
      near_pole += std::fabs(drawn.z) > 0.875F ? 1.0 / (kSide * kSide) : 0.0;
      const glm::vec3 any = ray_bundles::direction_on_sphere(u);
      if (std::fabs(any.z) <= 0.875F) continue;
      expected += 4.0 * std::numbers::pi * importance.density(any) / (kSide * kSide);
    }
  }
  EXPECT_GT(near_pole, 0.7);  // uniform: 0.125
  EXPECT_NEAR(near_pole, expected, 5e-3);
}

/// Weighted directions integrate what uniform ones do; without their weights they do not.
TEST(DirectionImportance, WeightsMakeUpForTheMixture) {
  constexpr std::int64_t kCount = 8192;
  for (const double share : {0.3, 0.8}) {
    DirectionSet set(DirectionKind::halton_permuted, 3, kCount);
    set.set_importance(DirectionImportance(weights_of_a_cap()), share);
    double weight = 0.0;
    double greatest = 0.0;
    double along_z = 0.0;
    double along_x = 0.0;
    double unweighted = 0.0;
    for (std::int64_t i = 0; i < kCount; ++i) {
      const BundleDirection bundle = set.at(i);
      const auto m = static_cast<double>(bundle.weight);
      weight += m / kCount;
      greatest = std::max(greatest, m);
      along_z += 2.0 * m * std::fabs(static_cast<double>(bundle.direction.z)) / kCount;
      along_x += 2.0 * m * std::fabs(static_cast<double>(bundle.direction.x)) / kCount;
      unweighted += 2.0 * std::fabs(static_cast<double>(bundle.direction.z)) / kCount;
    }
    EXPECT_NEAR(weight, 1.0, 5e-3);
    EXPECT_LE(greatest, 1.0 / (1.0 - share) + 1e-5);
    EXPECT_NEAR(along_z, 1.0, 1e-2);
    EXPECT_NEAR(along_x, 1.0, 1e-2);
    EXPECT_GT(unweighted, 1.1);
  }
}

TEST(DirectionImportance, NoLightLeavesDirectionsUniform) {
  DirectionSet uniform(DirectionKind::halton_permuted, 4, 64);
  DirectionSet empty(DirectionKind::halton_permuted, 4, 64);
  empty.set_importance(DirectionImportance(std::vector<double>(DirectionImportance::kCells, 0.0)),
                       0.5);
  for (std::int64_t i = 0; i < 64; ++i) {
    EXPECT_EQ(empty.at(i).direction, uniform.at(i).direction);
    EXPECT_EQ(empty.at(i).weight, 1.0F);
  }
}

/// A lamp of 0.2 m that faces a floor 2 m below: most of the density is upright.
TEST(DirectionImportance, LooksFromLightsToWhatTheyLight) {
  SceneBuilder builder;
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
  builder.add_quad({-0.1F, 2, -0.1F}, {0.2F, 0, 0}, {0, 0, 0.2F}, lamp);
  builder.add_quad({-0.5F, 0, -0.5F}, {0, 0, 1}, {1, 0, 0},
                   builder.add_material(lambert(glm::vec3(0.5F))));
  const BundleScene built(builder.scene, 32);
  ray_bundles::CarriedLight light;
  light.radiance.resize(2 * built.atlas.texels().size());
  for (std::uint32_t i = 0; i < built.atlas.texels().size(); ++i) {
    light.radiance[2 * i] = built.atlas.texels()[i].emission;
  }
  const DirectionImportance importance = measure_importance(built.rays, built.atlas, light);
  ASSERT_FALSE(importance.is_empty());
  const double uniform = 1.0 / (4.0 * std::numbers::pi);
  EXPECT_GT(importance.density(glm::normalize(glm::vec3(0.05F, 1.0F, 0.05F))), 3.0 * uniform);
  EXPECT_EQ(importance.density(glm::normalize(glm::vec3(1.0F, 0.1F, 0.3F))), 0.0);
}

/// A furnace has 1 / (1 - albedo) whatever the directions.
TEST(DirectionImportance, FurnaceIsTheGeometricSeries) {
  SceneBuilder builder;
  add_closed_box(builder, glm::vec3(-1.0F), {1.0F, 0.8F, 1.4F},
                 builder.add_material(lambert(glm::vec3(0.5F), glm::vec3(1.0F))), true);
  const Frame frame =
      render(builder.scene, {.renderer = "ray-bundles",
                             .settings = {"atlas_side=32", "lines=48", "direct=bundles",
                                          "importance=0.7", "camera_rays=1"},
                             .samples = 1000});
  EXPECT_NEAR(mean_of(frame.radiance), 2.0, 0.01);
}

/// Open to a sky with a sun, of which uniform directions meet little.
SceneBuilder sunny_court() {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.6F)));
  builder.add_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, white);
  builder.add_quad({-1, 0, 1}, {2, 0, 0}, {0, 1, 0}, white);
  builder.add_quad({-1, 0, -1}, {0, 1, 0}, {0, 0, 2}, white);
  builder.add_box({0.0F, 0.0F, 0.1F}, {0.4F, 0.6F, 0.5F}, white, false);
  auto sky = std::make_shared<scene::Environment>();
  sky->image = perception::make_rgb_image(64, 32, perception::Encoding::scene_linear);
  for (float& value : sky->image.pixels) value = 0.3F;
  constexpr std::size_t kSunPixel = 8 * 64 + 40;  // 42 degrees above the horizon
  for (std::size_t c = 0; c < 3; ++c) sky->image.pixels[3 * kSunPixel + c] = 200.0F;
  builder.scene.environment = sky;
  builder.look({0.4F, 1.3F, -2.6F}, {0.0F, 0.2F, 0.0F}, 45.0F);
  return builder;
}

/// Pictures by several seeds: their mean, and how they scatter.
struct Pictures {
  Mean mean;               ///< of all pixels
  double deviation = 0.0;  ///< of a pixel, root of the mean square
};

Pictures pictures(const SceneBuilder& builder, const std::vector<std::string>& settings,
                  std::int64_t samples = 128) {
  constexpr int kSeeds = 12;
  std::vector<perception::Image> images;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    std::vector<std::string> all{"atlas_side=48", "lines=64", "direct=bundles", "camera_rays=4"};
    all.insert(all.end(), settings.begin(), settings.end());
    images.push_back(render(builder.scene, {.renderer = "ray-bundles",
                                            .settings = all,
                                            .samples = samples,
                                            .seed = static_cast<std::uint64_t>(seed)})
                         .radiance);
  }
  Pictures result;
  std::vector<double> means(kSeeds, 0.0);
  const std::size_t values = images[0].pixels.size();
  for (std::size_t i = 0; i < values; ++i) {
    double sum = 0.0;
    double square = 0.0;
    for (std::size_t seed = 0; seed < kSeeds; ++seed) {
      const auto value = static_cast<double>(images[seed].pixels[i]);
      sum += value;
      square += value * value;
      means[seed] += value / static_cast<double>(values);
    }
    result.deviation += (square - sum * sum / kSeeds) / (kSeeds - 1) / static_cast<double>(values);
  }
  result.deviation = std::sqrt(result.deviation);
  double sum = 0.0;
  double square = 0.0;
  for (const double mean : means) {
    sum += mean / kSeeds;
    square += mean * mean / kSeeds;
  }
  result.mean.value.fill(sum);
  result.mean.sigma.fill(std::sqrt((square - sum * sum) / (kSeeds - 1)));
  return result;
}

/// The same light, to 3 % by the z-test, and a fifth of the noise.
TEST(DirectionImportance, FindsTheSunWithoutBias) {
  const SceneBuilder builder = sunny_court();
  const double truth =
      mean_of(render(builder.scene, {.settings = {"transport=diffuse"}, .samples = 4096}).radiance);
  for (const char* normalisation : {"normalisation=uniform", "normalisation=self"}) {
    const Pictures uniform = pictures(builder, {normalisation});
    const Pictures mixed = pictures(builder, {normalisation, "importance=0.5"});
    EXPECT_TRUE(agree(mixed.mean, truth, 0.03)) << to_string(mixed.mean) << " " << truth;
    EXPECT_TRUE(agree(mixed.mean, uniform.mean, 0.5))
        << to_string(mixed.mean) << to_string(uniform.mean);
    EXPECT_LT(mixed.deviation, 0.2 * uniform.deviation);
  }
}

/// At the greatest share a uniform direction weighs 20: the growing step, cut at 1, takes it for
/// less for as long as i < k (2 c - 1), 150 directions. The output has forgotten them.
TEST(DirectionImportance, TheCutOfTheGrowingStepIsForgotten) {
  const SceneBuilder builder = sunny_court();
  const double truth = mean_of(
      aov(render(builder.scene, {.settings = {"transport=diffuse"}, .samples = 4096}), "indirect"));
  const Pictures mixed =
      pictures(builder, {"importance=0.95", "part=indirect", "feed=growing_step"}, 640);
  EXPECT_TRUE(agree(mixed.mean, truth, 0.03)) << to_string(mixed.mean) << " " << truth;
}

/// Lobes that bundles light weigh them alike: with and without importance the same mean.
TEST(DirectionImportance, LobesHaveTheSameLight) {
  SceneBuilder builder = sunny_court();
  builder.scene.materials[0] = phong(glm::vec3(0.3F), glm::vec3(0.4F), 3.0F);
  const double truth =
      mean_of(render(builder.scene, {.settings = {"transport=full"}, .samples = 4096}).radiance);
  const Pictures mixed = pictures(
      builder, {"importance=0.5", "glossy=chain", "final_glossy=bundles", "pass_directions=32"});
  EXPECT_TRUE(agree(mixed.mean, truth, 0.05)) << to_string(mixed.mean) << " " << truth;
}

}  // namespace
}  // namespace renderers::test
