#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/renderers/ray_bundles/bundle_fixture.h"

/// Closed forms and laws of the transport by bundles, without a picture.
namespace renderers::test {
namespace {

using ray_bundles::BundleTransport;
using ray_bundles::DirectionKind;
using ray_bundles::FeedKind;
using ray_bundles::Normalisation;
using ray_bundles::TransferMode;
using ray_bundles::TransportSettings;
using texel_atlas::Side;

constexpr TransferMode kModes[] = {TransferMode::gather, TransferMode::scatter};

std::string name_of(TransferMode mode) {
  return mode == TransferMode::gather ? "gather" : "scatter";
}

TransportSettings settings_of(TransferMode mode, Normalisation normalisation, int lines_across) {
  TransportSettings settings;
  settings.mode = mode;
  settings.lines_across = lines_across;
  settings.solution.normalisation = normalisation;
  return settings;
}

// --- Form factors -------------------------------------------------------------------------------

/// Two unit squares that face each other at distance 1, or that share an edge at a right angle; the
/// first shines with radiance 1: J on the second is the form factor.
SceneBuilder squares(bool is_opposed) {
  SceneBuilder builder;
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
  const int wall = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, lamp);  // looks up
  if (is_opposed) {
    builder.add_quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, wall);  // looks down
  } else {
    builder.add_quad({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, wall);  // looks along +x
  }
  return builder;
}

TEST(RayBundleTransport, FormFactorsOfSquares) {
  for (const auto& [is_opposed, expected] : {std::pair{true, 0.19982}, std::pair{false, 0.20004}}) {
    const SceneBuilder builder = squares(is_opposed);
    for (const TransferMode mode : kModes) {
      for (const Normalisation norm : {Normalisation::self, Normalisation::uniform}) {
        BundleScene built(builder.scene, 32);
        const BundleTransport transport = transported(built, settings_of(mode, norm, 48), 1000);
        const double measured = light_on(built, transport.solution(), LightOf::direct, 1).mean.x;
        EXPECT_NEAR(measured, expected, 0.01 * expected)
            << name_of(mode) << (is_opposed ? " opposed" : " hinged");
        // A missing pi, a factor 4 for 2, or a further cosine is far outside.
        EXPECT_GT(std::fabs(measured / std::numbers::pi - expected), 0.05);
        EXPECT_EQ(light_on(built, transport.solution(), LightOf::direct, 1, Side::back).mean.x,
                  0.0);
      }
    }
  }
}

TEST(RayBundleTransport, EveryTexelReceivesTheLambertPolygon) {
  const SceneBuilder builder = squares(true);
  const std::vector<glm::dvec3> lamp{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}};
  for (const TransferMode mode : kModes) {
    BundleScene built(builder.scene, 24);
    const BundleTransport transport =
        transported(built, settings_of(mode, Normalisation::self, 64), 3000);
    double bias = 0.0;
    double square = 0.0;
    double count = 0.0;
    for (std::uint32_t i = 0; i < built.atlas.texels().size(); ++i) {
      const texel_atlas::Texel& texel = built.atlas.texels()[i];
      if (texel.point.object != 1) continue;
      const double truth = lambert_polygon(lamp, glm::dvec3(texel.point.position), {0, -1, 0});
      const double error =
          static_cast<double>(
              transport.solution().direct(texel_atlas::side_index(i, Side::front)).x) /
              truth -
          1.0;
      bias += error;
      square += error * error;
      count += 1.0;
    }
    EXPECT_LT(std::fabs(bias / count), 5e-3) << name_of(mode);
    EXPECT_LT(std::sqrt(square / count), 3e-2) << name_of(mode);
  }
}

/// Of smooth light the texels' constants are wrong by their size: the error over the floor between
/// two near squares falls about linearly with it.
TEST(RayBundleTransport, ErrorsFallWithTheSizeOfTexels) {
  SceneBuilder builder;
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
  const int wall = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad({0.25F, 0, 0.25F}, {0, 0, 0.5F}, {0.5F, 0, 0}, lamp);
  builder.add_quad({0, 0.2F, 0}, {1, 0, 0}, {0, 0, 1}, wall);
  const std::vector<glm::dvec3> corners{
      {0.25, 0, 0.25}, {0.25, 0, 0.75}, {0.75, 0, 0.75}, {0.75, 0, 0.25}};
  for (const TransferMode mode : kModes) {
    std::vector<double> errors;
    for (const int side_px : {16, 32, 64}) {
      BundleScene built(builder.scene, side_px);
      TransportSettings settings = settings_of(mode, Normalisation::self, 4 * side_px);
      settings.directions = DirectionKind::fibonacci;
      const BundleTransport transport = transported(built, settings, 3000);
      double square = 0.0;
      constexpr int kPlaces = 97;
      for (int i = 0; i < kPlaces * kPlaces; ++i) {
        const glm::dvec2 at((i % kPlaces + 0.5) / kPlaces, (i / kPlaces + 0.5) / kPlaces);
        ray_tracing::Hit hit;
        const ray_tracing::Ray up{{static_cast<float>(at.x), 0.1F, static_cast<float>(at.y)},
                                  {0.0F, 1.0F, 0.0F}};
        ASSERT_TRUE(built.rays.intersect(up, hit));
        const std::uint32_t texel =
            built.atlas.texel_at(hit.object, hit.triangle, hit.barycentrics);
        const double found = static_cast<double>(
            transport.solution().direct(texel_atlas::side_index(texel, Side::front)).x);
        const double truth = lambert_polygon(corners, {at.x, 0.2, at.y}, {0, -1, 0});
        square += (found - truth) * (found - truth) / (kPlaces * kPlaces);
      }
      errors.push_back(std::sqrt(square));
    }
    const double slope = std::log(errors[2] / errors[0]) / std::log(4.0);
    EXPECT_LT(slope, -0.7) << name_of(mode) << errors[0] << " " << errors[1] << " " << errors[2];
    EXPECT_GT(slope, -1.3) << name_of(mode) << errors[0] << " " << errors[1] << " " << errors[2];
  }
}

/// A F is the same both ways: a small square and a large one exchange roles.
TEST(RayBundleTransport, FormFactorsAreReciprocal) {
  double area_times_j[2] = {};
  for (const int shining : {0, 1}) {
    SceneBuilder builder;
    const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
    const int wall = builder.add_material(lambert(glm::vec3(0.5F)));
    builder.add_quad({0, 0, 0}, {0, 0, 1.5F}, {2, 0, 0}, shining == 0 ? lamp : wall);
    builder.add_quad({0.5F, 0.7F, 0.2F}, {0.6F, 0.3F, 0}, {0, 0, 0.5F}, shining == 1 ? lamp : wall);
    BundleScene built(builder.scene, 48);
    const BundleTransport transport =
        transported(built, settings_of(TransferMode::scatter, Normalisation::uniform, 96), 2000);
    const double area_m2 = shining == 0 ? std::sqrt(0.6 * 0.6 + 0.3 * 0.3) * 0.5 : 1.5 * 2.0;
    area_times_j[shining] =
        area_m2 * light_on(built, transport.solution(), LightOf::direct, 1 - shining).mean.x;
  }
  // The same lines cross both, whichever shines.
  EXPECT_NEAR(area_times_j[0], area_times_j[1], 1e-5 * area_times_j[0]);
  EXPECT_GT(area_times_j[0], 0.05);
}

// --- Furnace ------------------------------------------------------------------------------------

SceneBuilder furnace(float albedo) {
  SceneBuilder builder;
  const int wall = builder.add_material(lambert(glm::vec3(albedo), glm::vec3(1.0F)));
  builder.add_box(glm::vec3(-1.0F), {1.0F, 0.8F, 1.4F}, wall, true);
  return builder;
}

/// Radiance 1 + albedo J of every texel: 1 / (1 - albedo).
TEST(RayBundleTransport, FurnaceIsTheGeometricSeries) {
  for (const TransferMode mode : kModes) {
    for (const double albedo : {0.2, 0.5, 0.8}) {
      const SceneBuilder builder = furnace(static_cast<float>(albedo));
      BundleScene built(builder.scene, 32);
      const BundleTransport transport =
          transported(built, settings_of(mode, Normalisation::self, 48), 1000);
      const LightStatistics light = light_on(built, transport.solution(), LightOf::both);
      const double expected = 1.0 / (1.0 - albedo);
      EXPECT_NEAR(1.0 + albedo * light.mean.x, expected, 5e-3 * expected) << name_of(mode);
      EXPECT_NEAR(1.0 + albedo * light.least, expected, 1e-2 * expected) << name_of(mode);
      EXPECT_NEAR(1.0 + albedo * light.greatest, expected, 1e-2 * expected) << name_of(mode);
    }
  }
}

/// The paper's running mean: the reflected energy that misses is
/// Gamma(N + rho) / (Gamma(rho) Gamma(N + 1)), from i e_i = (i - 1 + rho) e_(i-1).
TEST(RayBundleTransport, RunningMeanLacksWhatTheGammaLawSays) {
  for (const TransferMode mode : kModes) {
    for (const double rho : {0.5, 0.8}) {
      const SceneBuilder builder = furnace(static_cast<float>(rho));
      for (const int n : {250, 1000}) {
        BundleScene built(builder.scene, 24);
        TransportSettings settings = settings_of(mode, Normalisation::self, 40);
        settings.solution.feed = FeedKind::running_mean;
        const BundleTransport transport = transported(built, settings, n);
        const double full = rho / (1.0 - rho);
        const double reflected = rho * light_on(built, transport.solution(), LightOf::both).mean.x;
        const double law = std::exp(std::lgamma(n + rho) - std::lgamma(rho) - std::lgamma(n + 1.0));
        EXPECT_NEAR(1.0 - reflected / full, law, 0.01) << name_of(mode) << " N " << n;
      }
    }
  }
}

TEST(RayBundleTransport, JacobiHasTheBouncesItHasAndStochasticAll) {
  const double rho = 0.6;
  const SceneBuilder builder = furnace(static_cast<float>(rho));
  BundleScene built(builder.scene, 24);
  TransportSettings settings = settings_of(TransferMode::scatter, Normalisation::self, 40);
  settings.solution.feed = FeedKind::jacobi;
  settings.solution.bounce_directions = 100;
  const BundleTransport jacobi = transported(built, settings, 500);
  // The direct light's pass, then four bounces: J = 1 + rho + ... + rho^4.
  double series = 0.0;
  for (int i = 0; i < 5; ++i) series += std::pow(rho, i);
  EXPECT_NEAR(light_on(built, jacobi.solution(), LightOf::both).mean.x, series, 0.01 * series);

  settings.solution.feed = FeedKind::stochastic;
  settings.directions = DirectionKind::iid;
  const BundleTransport stochastic = transported(built, settings, 2000);
  EXPECT_NEAR(light_on(built, stochastic.solution(), LightOf::both).mean.x, 1.0 / (1.0 - rho),
              0.03 / (1.0 - rho));
}

// --- Laws ---------------------------------------------------------------------------------------

SceneBuilder room_with_block() {
  SceneBuilder builder;
  const int wall = builder.add_material(lambert({0.7F, 0.6F, 0.5F}));
  const int lamp = builder.add_material(lambert(glm::vec3(0.3F), glm::vec3(4.0F)));
  builder.add_box(glm::vec3(-1.0F), {1.0F, 1.1F, 1.0F}, wall, true);
  builder.add_box({-0.5F, -0.95F, -0.4F}, {0.1F, -0.2F, 0.3F}, wall, false);
  builder.add_quad({-0.3F, 1.05F, -0.3F}, {0.7F, 0, 0}, {0, 0, 0.7F}, lamp);
  return builder;
}

/// Per direction, sum A dJ = a_p sum over neighbours (L_x + L_y), times 2 / N = 2.
TEST(RayBundleTransport, ScatterConservesPowerInEveryDirection) {
  const SceneBuilder builder = room_with_block();
  BundleScene built(builder.scene, 64);
  ray_bundles::DirectionSet set(DirectionKind::iid, 5, 0);
  ray_bundles::BundleLists lists;
  const auto texels = ray_bundles::exchange_texels(built.atlas);
  ray_bundles::Scatter scatter(texels);
  for (std::int64_t i = 0; i < 10; ++i) {
    const ray_bundles::BundleFrame frame(built.box, set.at(i), 80);
    ray_bundles::trace_lists(built.rays, built.atlas, frame, lists);
    ray_bundles::SolutionSettings settings;
    settings.normalisation = Normalisation::uniform;
    ray_bundles::LightSolution solution(built.atlas, settings);
    double sent = 0.0;
    for (int y = 0; y < frame.height_px; ++y) {
      for (int x = 0; x < frame.width_px; ++x) {
        const auto line = lists.line(x, y);
        for (std::size_t n = 0; n + 1 < line.size(); ++n) {
          sent += static_cast<double>(solution.emitted(line[n + 1].near_side).x +
                                      solution.emitted(far_side(line[n])).x);
        }
      }
    }
    solution.begin_direction();
    scatter.exchange({frame, lists, {}}, solution);
    solution.end_direction();
    double received = 0.0;
    for (std::uint32_t side = 0; side < 2 * built.atlas.texels().size(); ++side) {
      received += static_cast<double>(built.atlas.texels()[side / 2].area_m2) *
                  static_cast<double>(solution.direct(side).x);
    }
    const double expected = 2.0 * static_cast<double>(frame.pixel_area_m2()) * sent;
    EXPECT_GT(sent, 0.0);
    EXPECT_NEAR(received, expected, 1e-5 * expected);
  }
}

/// Crossings of a texel that lies along the lines are rounding: it goes on as if it were missed.
TEST(RayBundleTransport, TexelsAlongTheLinesAreMissed) {
  SceneBuilder builder;
  const int wall = builder.add_material(lambert(glm::vec3(0.5F)));
  builder.add_quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, wall);
  BundleScene built(builder.scene, 16);
  const auto texels = ray_bundles::exchange_texels(built.atlas);
  ray_bundles::Scatter scatter(texels);
  for (const bool is_along : {true, false}) {
    const glm::vec3 direction = is_along ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
    const ray_bundles::BundleFrame frame(built.box, {direction, 0.0F, glm::vec2(0.0F)}, 4);
    ray_bundles::BundleLists lists;
    lists.reset(frame);
    for (std::size_t band = 0; band < lists.band_count(); ++band) {
      const int rows = std::min(ray_bundles::BundleLists::kBandRows, frame.height_px);
      for (int line = 0; line < rows * frame.width_px; ++line) {
        lists.band(band).nodes.push_back({1.0F, 0});
        lists.band(band).ends.push_back(static_cast<std::uint32_t>(line + 1));
      }
    }
    ray_bundles::LightSolution solution(built.atlas, {});
    solution.begin_direction();
    scatter.exchange({frame, lists, {glm::vec3(3.0F), glm::vec3(3.0F)}}, solution);
    solution.end_direction();
    EXPECT_EQ(solution.received().direct.weight[0] > 0.0F, !is_along);
    EXPECT_EQ(solution.direct(0).x > 0.0F || solution.direct(1).x > 0.0F, !is_along);
  }
}

TEST(RayBundleTransport, GatherAndScatterAgree) {
  const SceneBuilder builder = room_with_block();
  BundleScene built(builder.scene, 96);
  LightStatistics light[2][2];
  for (const TransferMode mode : kModes) {
    const BundleTransport transport =
        transported(built, settings_of(mode, Normalisation::self, 96), 1000);
    auto& row = light[static_cast<int>(mode)];
    row[0] = light_on(built, transport.solution(), LightOf::direct);
    row[1] = light_on(built, transport.solution(), LightOf::indirect);
  }
  for (const int part : {0, 1}) {
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(light[0][part].mean[channel], light[1][part].mean[channel],
                  0.01 * light[1][part].mean[channel]);
    }
  }
}

/// Turned about an oblique axis, the room has the same light.
TEST(RayBundleTransport, DoesNotDependOnTheSceneAttitude) {
  const SceneBuilder builder = room_with_block();
  scene::Scene turned = builder.scene;
  for (scene::Object& object : turned.objects) {
    object.to_world = glm::rotate(glm::mat4(1.0F), 0.7F, {0.3F, 0.8F, -0.5F}) * object.to_world;
  }
  for (const TransferMode mode : kModes) {
    glm::dvec3 means[2];
    for (const int i : {0, 1}) {
      BundleScene built(i == 0 ? builder.scene : turned, 64);
      const BundleTransport transport =
          transported(built, settings_of(mode, Normalisation::self, 96), 1000);
      means[i] = light_on(built, transport.solution(), LightOf::both).mean;
    }
    EXPECT_NEAR(means[0].x, means[1].x, 0.015 * means[0].x) << name_of(mode);
  }
}

/// What a direction costs is counted in lines, nodes and pairs: the number of lights is in none.
TEST(RayBundleTransport, ManyLightsAreNoMoreWorkThanOne) {
  ray_bundles::TransportCounts counts[2];
  double light[2] = {};
  for (const int many : {0, 1}) {
    SceneBuilder builder;
    const int wall = builder.add_material(lambert(glm::vec3(0.5F)));
    const int dark = builder.add_material(lambert(glm::vec3(0.5F)));
    const int bright = builder.add_material(lambert(glm::vec3(0.5F), glm::vec3(3.0F)));
    builder.add_box(glm::vec3(-1.0F), glm::vec3(1.0F), wall, true);
    for (int i = 0; i < 100; ++i) {
      const glm::vec3 corner(-0.95F + 0.19F * static_cast<float>(i % 10), 0.98F,
                             -0.95F + 0.19F * static_cast<float>(i / 10));
      const bool shines = many == 1 || i == 44;
      builder.add_quad(corner, {0.1F, 0, 0}, {0, 0, 0.1F}, shines ? bright : dark);
    }
    BundleScene built(builder.scene, 128);
    const BundleTransport transport =
        transported(built, settings_of(TransferMode::scatter, Normalisation::self, 64), 50);
    counts[many] = transport.counts();
    light[many] = light_on(built, transport.solution(), LightOf::direct, 2).mean.x;
  }
  EXPECT_GT(light[1], 20.0 * light[0]);
  EXPECT_EQ(counts[0].lines, counts[1].lines);
  EXPECT_EQ(counts[0].nodes, counts[1].nodes);
  EXPECT_EQ(counts[0].exchange.pairs, counts[1].exchange.pairs);
}

/// A white environment around one convex body: J = 1 on all of it, in every sample.
TEST(RayBundleTransport, WhiteEnvironmentGivesAConvexBodyItsAlbedo) {
  SceneBuilder builder;
  const int wall = builder.add_material(lambert(glm::vec3(0.6F)));
  add_closed_box(builder, glm::vec3(-0.5F), glm::vec3(0.7F), wall, false);
  builder.set_environment(glm::vec3(1.0F));
  for (const TransferMode mode : kModes) {
    BundleScene built(builder.scene, 32);
    const BundleTransport transport =
        transported(built, settings_of(mode, Normalisation::self, 48), 100);
    const LightStatistics light = light_on(built, transport.solution(), LightOf::both);
    EXPECT_NEAR(light.least, 1.0, 1e-5) << name_of(mode);
    EXPECT_NEAR(light.greatest, 1.0, 1e-5) << name_of(mode);
    EXPECT_EQ(light_on(built, transport.solution(), LightOf::both, -1, Side::back).greatest, 0.0);
  }
  // A body with a hollow sees itself: never more than the environment, less inside.
  builder.add_quad({0.7F, -0.5F, -0.5F}, {1, 0, 0}, {0, 0, 1}, wall);
  BundleScene hollow(builder.scene, 32);
  const BundleTransport transport =
      transported(hollow, settings_of(TransferMode::scatter, Normalisation::self, 48), 300);
  const LightStatistics light = light_on(hollow, transport.solution(), LightOf::both);
  EXPECT_LT(light.greatest, 1.0 + 1e-4);
  EXPECT_LT(light.mean.x, 0.99);
}

/// Light inside an inner box does not get out; light on one side of a sheet not to the other.
TEST(RayBundleTransport, WallsDoNotLeak) {
  SceneBuilder builder;
  const int wall = builder.add_material(lambert(glm::vec3(0.7F)));
  const int glow = builder.add_material(lambert(glm::vec3(0.7F), glm::vec3(1.0F)));
  add_closed_box(builder, glm::vec3(-1.0F), glm::vec3(1.0F), wall, true);
  add_closed_box(builder, glm::vec3(-0.5F), glm::vec3(0.4F), glow, true);
  for (const TransferMode mode : kModes) {
    BundleScene built(builder.scene, 64);
    const BundleTransport transport =
        transported(built, settings_of(mode, Normalisation::self, 96), 200);
    for (const Side side : {Side::front, Side::back}) {
      const LightStatistics outer = light_on(built, transport.solution(), LightOf::both, 0, side);
      EXPECT_EQ(outer.greatest, 0.0) << name_of(mode);
    }
    EXPECT_EQ(light_on(built, transport.solution(), LightOf::both, 1, Side::back).greatest, 0.0);
    EXPECT_GT(light_on(built, transport.solution(), LightOf::both, 1).mean.x, 2.0);
  }
}

TEST(RayBundleTransport, TwoCoincidentTrianglesKeepTheirSidesApart) {
  SceneBuilder builder;
  const int wall = builder.add_material(lambert(glm::vec3(0.7F)));
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F)));
  // A sheet of two quads back to back, tilted so that depths round; the lamp is above.
  builder.add_quad({0, 0, 0}, {0, 0.1F, 1}, {1, 0.2F, 0}, wall);  // looks up
  builder.add_quad({0, 0, 0}, {1, 0.2F, 0}, {0, 0.1F, 1}, wall);  // looks down
  builder.add_quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, lamp);        // looks down
  BundleScene built(builder.scene, 48);
  const BundleTransport transport =
      transported(built, settings_of(TransferMode::scatter, Normalisation::self, 96), 300);
  EXPECT_GT(light_on(built, transport.solution(), LightOf::direct, 0).mean.x, 0.1);
  EXPECT_EQ(light_on(built, transport.solution(), LightOf::direct, 1).greatest, 0.0);
  EXPECT_EQ(light_on(built, transport.solution(), LightOf::direct, 0, Side::back).greatest, 0.0);
}

}  // namespace
}  // namespace renderers::test
