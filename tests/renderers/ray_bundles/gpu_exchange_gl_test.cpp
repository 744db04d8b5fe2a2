#include "renderers/ray_bundles/gpu_exchange.h"

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "tests/renderers/opengl/platform_test.h"
#include "tests/renderers/ray_bundles/bundle_fixture.h"

/// Light exchanged on the device against the CPU's exchange of the same lists.
namespace renderers::ray_bundles {
namespace {

using test::BundleScene;
using test::SceneBuilder;

class GpuExchangeTest : public opengl::PlatformTest {
 protected:
  /// After so many directions; `settings.exchange` says where.
  BundleTransport transported(BundleScene& built, TransportSettings settings,
                              std::int64_t directions, std::int64_t fetched_at = -1) {
    settings.device = context_;
    settings.planned = directions;
    BundleTransport transport(built.rays, built.atlas, settings, built.timer);
    std::vector<glm::vec3> known(2 * built.atlas.texels().size());
    for (std::size_t side = 0; side < known.size(); ++side) {
      known[side] = glm::vec3(static_cast<float>(side % 7) * 0.1F, 0.2F, 0.05F);
    }
    if (!settings.solution.carries_emission) transport.set_known_direct(std::move(known));
    transport.aim(built.timer);
    for (std::int64_t i = 0; i < directions; ++i) {
      transport.add_direction(built.timer);
      if (i == fetched_at) transport.fetch(built.timer);
    }
    transport.fetch(built.timer);
    return transport;
  }
};
INSTANTIATE_TEST_SUITE_P(Platforms, GpuExchangeTest, opengl::all_platforms(),
                         opengl::platform_label);

/// An open room under a sky, with a lamp and a ball of smooth normals.
SceneBuilder open_room() {
  SceneBuilder builder;
  const int wall = builder.add_material(test::lambert({0.7F, 0.5F, 0.3F}));
  const int lamp = builder.add_material(test::lambert(glm::vec3(0.4F), {5.0F, 4.0F, 3.0F}));
  builder.add_quad({-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, wall);
  builder.add_quad({-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, wall);
  builder.add_quad({-1, -1, -1}, {0, 2, 0}, {0, 0, 2}, wall);
  builder.add_quad({-0.4F, 0.95F, -0.4F}, {0.8F, 0, 0}, {0, 0, 0.8F}, lamp);
  builder.add_sphere({0.3F, -0.4F, 0.2F}, 0.4F, 12, wall);
  auto sky = std::make_shared<scene::Environment>();
  sky->image = perception::make_rgb_image(8, 4, perception::Encoding::scene_linear);
  for (std::size_t i = 0; i < sky->image.pixels.size(); ++i) {
    sky->image.pixels[i] = 0.05F * static_cast<float>(i % 17);
  }
  builder.scene.environment = std::move(sky);
  return builder;
}

struct Mode {
  std::string name;
  std::function<void(TransportSettings&)> change;
};

std::vector<Mode> modes() {
  return {{"plain", [](TransportSettings&) {}},
          {"met emitters", [](TransportSettings& s) { s.solution.carries_emission = true; }},
          {"running mean", [](TransportSettings& s) { s.solution.feed = FeedKind::running_mean; }},
          {"uniform mean of met emitters",
           [](TransportSettings& s) {
             s.solution.feed = FeedKind::running_mean;
             s.solution.normalisation = Normalisation::uniform;
             s.solution.carries_emission = true;
           }},
          {"front sides", [](TransportSettings& s) { s.solution.has_back_sides = false; }},
          {"direct first", [](TransportSettings& s) { s.solution.direct_only = 12; }},
          {"no restart", [](TransportSettings& s) { s.solution.restarts_output = false; }},
          {"aimed",
           [](TransportSettings& s) {
             s.importance = 0.5;
             s.solution.carries_emission = true;
           }},
          {"slots",
           [](TransportSettings& s) {
             s.lists = ListKind::fixed_k;
             s.slots.slots = 2;
           }},
          {"traced", [](TransportSettings& s) { s.lists = ListKind::trace; }},
          {"few slots", [](TransportSettings& s) {
             s.lists = ListKind::fixed_k;
             s.slots = {1, false};
           }}};
}

TransportSettings settings_of(const Mode& mode, ExchangePlace place, int lines_across) {
  TransportSettings settings;
  settings.lines_across = lines_across;
  settings.solution.carries_emission = false;
  settings.exchange = place;
  mode.change(settings);
  return settings;
}

/// Greatest difference of two solutions' light over any side, by the mean light of the first.
double greatest_difference(const BundleScene& built, const LightSolution& a,
                           const LightSolution& b) {
  double greatest = 0.0;
  double sum = 0.0;
  const auto sides = static_cast<std::uint32_t>(2 * built.atlas.texels().size());
  for (std::uint32_t side = 0; side < sides; ++side) {
    const auto differ = [&](const glm::vec3& x, const glm::vec3& y) {
      greatest = std::max(greatest, static_cast<double>(glm::length(x - y)));
    };
    differ(a.direct(side), b.direct(side));
    differ(a.indirect(side), b.indirect(side));
    differ(a.feed(side), b.feed(side));
    differ(a.reflected(side), b.reflected(side));
    sum += static_cast<double>(glm::length(a.direct(side) + a.indirect(side)));
  }
  return greatest / (sum / sides);
}

TEST_P(GpuExchangeTest, IsTheCpusInEveryMode) {
  const SceneBuilder builder = open_room();
  for (const Mode& mode : modes()) {
    // Few lines and many to a texel.
    for (const int lines : {32, 200}) {
      BundleScene built(builder.scene, 48);
      const BundleTransport cpu =
          transported(built, settings_of(mode, ExchangePlace::cpu, lines), 21);
      const BundleTransport gpu =
          transported(built, settings_of(mode, ExchangePlace::device, lines), 21);
      ASSERT_EQ(gpu.solution().directions(), 21);
      EXPECT_LT(greatest_difference(built, cpu.solution(), gpu.solution()), 1e-4)
          << mode.name << " " << lines;
      EXPECT_EQ(gpu.counts().exchange.receivers, cpu.counts().exchange.receivers) << mode.name;
      EXPECT_EQ(gpu.counts().exchange.pairs, cpu.counts().exchange.pairs) << mode.name;
      EXPECT_EQ(gpu.counts().exchange.lit_pairs, cpu.counts().exchange.lit_pairs) << mode.name;
      EXPECT_EQ(gpu.counts().nodes, cpu.counts().nodes) << mode.name;
      EXPECT_EQ(gpu.counts().dropped, cpu.counts().dropped) << mode.name;
    }
  }
}

TEST_P(GpuExchangeTest, IsTheCpusWhereEmissionDependsOnTheDirection) {
  SceneBuilder builder = open_room();
  builder.scene.materials[1].emission_profile = {1.0F, 0.8F, 0.2F, 0.0F};
  BundleScene built(builder.scene, 48);
  const Mode mode = modes()[1];
  const BundleTransport cpu = transported(built, settings_of(mode, ExchangePlace::cpu, 64), 21);
  const BundleTransport gpu = transported(built, settings_of(mode, ExchangePlace::device, 64), 21);
  EXPECT_LT(greatest_difference(built, cpu.solution(), gpu.solution()), 1e-4);
  const SceneBuilder plain = open_room();
  BundleScene even(plain.scene, 48);
  const BundleTransport other = transported(even, settings_of(mode, ExchangePlace::cpu, 64), 21);
  EXPECT_GT(greatest_difference(built, cpu.solution(), other.solution()), 1e-1);
}

/// Not to be mistaken: one direction more or less is far outside the tolerance.
TEST_P(GpuExchangeTest, AnotherDirectionIsAnotherSolution) {
  const SceneBuilder builder = open_room();
  BundleScene built(builder.scene, 48);
  const TransportSettings settings = settings_of(modes()[1], ExchangePlace::device, 32);
  const BundleTransport more = transported(built, settings, 22);
  const BundleTransport fewer = transported(built, settings, 21);
  EXPECT_GT(greatest_difference(built, more.solution(), fewer.solution()), 1e-2);
}

TEST_P(GpuExchangeTest, IsTheSameEveryTimeAndWhoeverLooks) {
  const SceneBuilder builder = open_room();
  BundleScene built(builder.scene, 24);
  // Many lines to a texel, from work groups that run at once.
  const TransportSettings settings = settings_of(modes()[1], ExchangePlace::device, 400);
  const BundleTransport first = transported(built, settings, 21);
  for (const std::int64_t fetched_at : {-1, 3, 15}) {
    const BundleTransport again = transported(built, settings, 21, fetched_at);
    EXPECT_EQ(greatest_difference(built, first.solution(), again.solution()), 0.0) << fetched_at;
  }
}

/// A bundle that no storage block holds brings the light back to the CPU, and it goes on there.
TEST_P(GpuExchangeTest, GoesOnWithTheCpuWhereABundleDoesNotFit) {
  const SceneBuilder builder = open_room();
  BundleScene built(builder.scene, 48);
  TransportSettings settings = settings_of(modes()[1], ExchangePlace::cpu, 200);
  settings.directions = DirectionKind::iid;  // the same for any number of them
  // Directions of which the first has fewer crossings than a later one.
  std::uint64_t first = 0;
  std::uint64_t most = 0;
  for (settings.seed = 1; first == most && settings.seed < 9; ++settings.seed) {
    std::uint64_t nodes = 0;
    first = most = 0;
    for (std::int64_t n = 1; n <= 9; ++n) {
      const std::uint64_t all = transported(built, settings, n).counts().nodes;
      if (n == 1) first = all;
      most = std::max(most, all - nodes);
      nodes = all;
    }
  }
  --settings.seed;
  ASSERT_LT(first, most);
  const BundleTransport cpu = transported(built, settings, 9);
  EXPECT_EQ(cpu.note(), "");
  settings.exchange = ExchangePlace::automatic;
  settings.takes_software = true;
  const BundleTransport whole = transported(built, settings, 9);
  EXPECT_EQ(whole.note(), "");
  settings.most_block_bytes = static_cast<std::int64_t>(most * sizeof(ListNode)) - 1;
  const BundleTransport gpu = transported(built, settings, 9);
  EXPECT_TRUE(gpu.note().starts_with("exchange auto: the CPU exchanges light from direction "))
      << gpu.note();
  EXPECT_EQ(gpu.note().find("direction 0 on"), std::string::npos) << gpu.note();
  EXPECT_EQ(gpu.solution().directions(), 9);
  EXPECT_LT(greatest_difference(built, cpu.solution(), gpu.solution()), 1e-4);
  EXPECT_EQ(gpu.counts().nodes, cpu.counts().nodes);
  EXPECT_EQ(gpu.counts().lines, cpu.counts().lines);
  EXPECT_EQ(gpu.counts().exchange.pairs, cpu.counts().exchange.pairs);
  settings.exchange = ExchangePlace::device;
  EXPECT_THROW(transported(built, settings, 9), UnsupportedError);
}

/// Thousands of lines to a texel: the CPU's light, or an error where a software driver ends loops.
TEST_P(GpuExchangeTest, LosesNoLightOfManyLinesSilently) {
  SceneBuilder builder;
  const int wall = builder.add_material(test::lambert(glm::vec3(0.5F)));
  builder.add_quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, wall);
  builder.set_environment({0.3F, 0.4F, 0.6F});
  BundleScene built(builder.scene, 8);
  const auto difference = [&](int lines) {
    const Mode mode = modes()[1];
    const BundleTransport cpu = transported(built, settings_of(mode, ExchangePlace::cpu, lines), 3);
    const BundleTransport gpu =
        transported(built, settings_of(mode, ExchangePlace::device, lines), 3);
    return greatest_difference(built, cpu.solution(), gpu.solution());
  };
  EXPECT_LT(difference(64), 1e-4);
  if (!context_->is_software()) {
    EXPECT_LT(difference(1024), 1e-3);
    return;
  }
  try {
    difference(1024);
    ADD_FAILURE() << "no error";
  } catch (const UnsupportedError& error) {
    EXPECT_NE(std::string(error.what()).find("exchange cpu, fewer lines, or a larger atlas_side"),
              std::string::npos)
        << error.what();
  }
}

/// Radiance 1 + albedo J of every texel: 1 / (1 - albedo).
TEST_P(GpuExchangeTest, FurnaceIsTheGeometricSeries) {
  constexpr double kAlbedo = 0.8;
  SceneBuilder builder;
  const int wall =
      builder.add_material(test::lambert(glm::vec3(static_cast<float>(kAlbedo)), glm::vec3(1.0F)));
  builder.add_box(glm::vec3(-1.0F), {1.0F, 0.8F, 1.4F}, wall, true);
  BundleScene built(builder.scene, 32);
  TransportSettings settings;
  settings.lines_across = 48;
  settings.exchange = ExchangePlace::device;
  const BundleTransport transport = transported(built, settings, 1000);
  const test::LightStatistics light =
      test::light_on(built, transport.solution(), test::LightOf::both);
  const double expected = 1.0 / (1.0 - kAlbedo);
  EXPECT_NEAR(1.0 + kAlbedo * light.mean.x, expected, 5e-3 * expected);
  EXPECT_NEAR(1.0 + kAlbedo * light.least, expected, 1e-2 * expected);
  EXPECT_NEAR(1.0 + kAlbedo * light.greatest, expected, 1e-2 * expected);
}

TEST_P(GpuExchangeTest, RefusesWhatStaysOnTheCpu) {
  SceneBuilder builder = open_room();
  scene::Texture checks;
  checks.image = perception::make_rgb_image(2, 1, perception::Encoding::scene_linear);
  checks.image.pixels = {1.0F, 0.8F, 0.6F, 0.2F, 0.3F, 0.4F};
  builder.scene.textures.push_back(std::move(checks));
  builder.scene.materials.front().albedo_texture = 0;
  BundleScene built(builder.scene, 48);
  TransportSettings settings = settings_of(modes()[0], ExchangePlace::device, 32);
  try {
    transported(built, settings, 1);
    ADD_FAILURE() << "no error";
  } catch (const UnsupportedError& error) {
    EXPECT_NE(std::string(error.what()).find("textures texel, or exchange cpu"), std::string::npos);
  }
  settings.textures_at_points = false;
  EXPECT_EQ(transported(built, settings, 1).solution().directions(), 1);

  // Lists that one storage block does not hold.
  GpuBundleLists small(context_, texel_atlas::world_triangles(builder.scene), built.atlas, 70'000);
  const BundleFrame frame(built.box, {{0.0F, 0.6F, 0.8F}, 0.0F, glm::vec2(0.0F)}, 140);
  try {
    small.keep(frame, nullptr, built.timer);
    ADD_FAILURE() << "no error";
  } catch (const UnsupportedError& error) {
    EXPECT_NE(std::string(error.what()).find("accepted: exchange cpu, or fewer lines"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace renderers::ray_bundles
