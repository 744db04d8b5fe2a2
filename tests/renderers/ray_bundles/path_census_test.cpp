#include "renderers/ray_bundles/path_census.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/expect_input_error.h"
#include "tests/renderers/ray_bundles/bundle_fixture.h"

/// Light by the length of its path (Hermes et al. 2010, Sec. 5.5 and Fig. 7).
namespace renderers::test {
namespace {

using ray_bundles::BundleTransport;
using ray_bundles::FeedKind;
using ray_bundles::TransferMode;
using ray_bundles::TransportSettings;

constexpr double kAlbedo = 0.6;
constexpr int kMost = 6;

SceneBuilder furnace() {
  SceneBuilder builder;
  const int wall =
      builder.add_material(lambert(glm::vec3(static_cast<float>(kAlbedo)), glm::vec3(1.0F)));
  add_closed_box(builder, glm::vec3(-1.0F), {1.0F, 0.8F, 1.4F}, wall, true);
  return builder;
}

TransportSettings settings_of(FeedKind feed, TransferMode mode) {
  TransportSettings settings;
  settings.lines_across = 40;
  settings.mode = mode;
  settings.census = kMost;
  settings.solution.feed = feed;
  return settings;
}

/// Share of light reflected k times that a running mean of n directions has in a furnace: direction
/// i brings what its senders had after i - 1, so c(i, k) = ((i - 1) c(i - 1, k) + c(i - 1, k - 1))
/// / i.
double share_of_running_mean(int n, int k) {
  std::vector<double> c(static_cast<std::size_t>(k) + 1, 0.0);
  for (int i = 1; i <= n; ++i) {
    for (std::size_t j = c.size() - 1; j > 0; --j) c[j] = ((i - 1) * c[j] + c[j - 1]) / i;
    c[0] = 1.0;
  }
  return c.back();
}

/// "L_x contains light that was reflected up to i times": no more than that is there, and no less.
TEST(PathCensus, DirectionsBringOneReflectionMoreEach) {
  const SceneBuilder builder = furnace();
  for (const TransferMode mode : {TransferMode::gather, TransferMode::scatter}) {
    for (const int n : {1, 2, 4, 6}) {
      BundleScene built(builder.scene, 24);
      const BundleTransport transport =
          transported(built, settings_of(FeedKind::running_mean, mode), n);
      const std::vector<double> light = transport.light_by_reflections();
      ASSERT_EQ(light.size(), static_cast<std::size_t>(kMost) + 1);
      for (int k = 0; k <= kMost; ++k) {
        const double found = light[static_cast<std::size_t>(k)];
        if (k < n) {
          EXPECT_GT(found, 0.0) << n << " " << k;
        } else {
          EXPECT_EQ(found, 0.0) << n << " " << k;
        }
      }
    }
  }
}

TEST(PathCensus, AFurnaceHasTheNeumannSeries) {
  const SceneBuilder builder = furnace();
  for (const int n : {20, 400}) {
    BundleScene built(builder.scene, 24);
    const BundleTransport transport =
        transported(built, settings_of(FeedKind::running_mean, TransferMode::scatter), n);
    const std::vector<double> light = transport.light_by_reflections();
    for (int k = 0; k <= kMost; ++k) {
      const double expected = std::pow(kAlbedo, k) * share_of_running_mean(n, k);
      // Few directions know the cosine to some percent, and each reflection multiplies that.
      const double tolerance = (n == 20 ? 0.03 : 0.007) * (k + 1);
      EXPECT_NEAR(light[static_cast<std::size_t>(k)], expected, tolerance * expected + 1e-4)
          << n << " " << k;
    }
  }
  BundleScene built(builder.scene, 24);
  const BundleTransport transport =
      transported(built, settings_of(FeedKind::growing_step, TransferMode::scatter), 1000);
  const std::vector<double> light = transport.light_by_reflections();
  for (int k = 0; k <= kMost; ++k) {
    const double expected = std::pow(kAlbedo, k);
    EXPECT_NEAR(light[static_cast<std::size_t>(k)], expected, 0.01 * expected) << k;
  }
}

/// All lengths together are the light of the solution that is counted, which they leave as it is.
TEST(PathCensus, SumsUpToTheSolution) {
  SceneBuilder builder;
  const int white = builder.add_material(lambert({0.3F, 0.2F, 0.1F}));
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(5.0F)));
  add_closed_box(builder, glm::vec3(-1.0F), glm::vec3(1.0F), white, true);
  builder.add_quad({-0.4F, 0.95F, -0.4F}, {0.8F, 0, 0}, {0, 0, 0.8F}, lamp);
  for (const FeedKind feed : {FeedKind::growing_step, FeedKind::running_mean}) {
    TransportSettings settings = settings_of(feed, TransferMode::scatter);
    settings.census = 12;  // what is left out: 0.3^13
    BundleScene built(builder.scene, 32);
    const BundleTransport counted = transported(built, settings, 40);
    settings.census = 0;
    const BundleTransport plain = transported(built, settings, 40);
    double whole = 0.0;
    double area_m2 = 0.0;
    for (std::uint32_t side = 0; side < 2 * built.atlas.texels().size(); ++side) {
      const double area = static_cast<double>(built.atlas.texels()[side / 2].area_m2);
      const glm::vec3 light = plain.solution().direct(side) + plain.solution().indirect(side);
      EXPECT_EQ(light, counted.solution().direct(side) + counted.solution().indirect(side));
      whole +=
          area * static_cast<double>(0.2126F * light.r + 0.7152F * light.g + 0.0722F * light.b);
      area_m2 += 0.5 * area;
    }
    double sum = 0.0;
    for (const double light : counted.light_by_reflections()) sum += light;
    EXPECT_NEAR(sum, whole / area_m2, 1e-4 * sum);
    EXPECT_TRUE(plain.light_by_reflections().empty());
  }
}

TEST(PathCensus, IsOfSolutionsThatKeepTheirLight) {
  EXPECT_EQ(
      tests::input_error_of([] {
        render(furnace().scene,
               {.renderer = "ray-bundles", .settings = {"census=2", "feed=jacobi"}, .samples = 4});
      }),
      "ray-bundles: census with glossy chain or feed jacobi; accepted: glossy last_surface "
      "and another feed");
  const Frame frame = render(
      furnace().scene, {.renderer = "ray-bundles",
                        .settings = {"census=2", "atlas_side=32", "lines=32", "direct=bundles"},
                        .samples = 2});
  EXPECT_NEAR(counter(frame, "reflected_0"), 1.0, 0.02);
  EXPECT_GT(counter(frame, "reflected_1"), 0.0);
  EXPECT_EQ(counter(frame, "reflected_2"), 0.0);
}

}  // namespace
}  // namespace renderers::test
