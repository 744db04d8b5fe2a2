#include "renderers/ray_bundles/ray_bundles_settings.h"

#include <gtest/gtest.h>

#include "tests/expect_input_error.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::ray_bundles {
namespace {

Settings of_preset(const std::string& name) {
  const RendererInfo& info = find_renderer("ray-bundles", {});
  const base::Preset& preset = find_preset(info, name, {});
  return settings_of(base::resolve_parameters(info.parameters, &preset, {}, info.name));
}

TEST(RayBundlesSettings, PaperIsThePapers) {
  const Settings paper = of_preset("paper");
  EXPECT_EQ(paper.samples, 2000);
  EXPECT_EQ(paper.direct, DirectMode::bundles);
  EXPECT_EQ(paper.transport.directions, DirectionKind::halton);
  EXPECT_EQ(paper.transport.mode, TransferMode::gather);
  EXPECT_EQ(paper.transport.lines_across, 1024);
  EXPECT_FALSE(paper.transport.textures_at_points);
  EXPECT_EQ(paper.transport.solution.feed, FeedKind::running_mean);
  EXPECT_EQ(paper.transport.solution.normalisation, Normalisation::uniform);
  EXPECT_EQ(paper.transport.solution.direct_only, 8);
  EXPECT_TRUE(paper.transport.solution.carries_emission);
  EXPECT_EQ(paper.transport.importance, 0.0);
  EXPECT_FALSE(paper.soft.shadows.has_receiver_plane);
  EXPECT_EQ(paper.atlas.side_px, 2048);
}

TEST(RayBundlesSettings, BestCorrectsThem) {
  const Settings best = of_preset("best");
  EXPECT_EQ(best.direct, DirectMode::next_event);
  EXPECT_EQ(best.transport.directions, DirectionKind::halton_permuted);
  EXPECT_EQ(best.transport.solution.feed, FeedKind::growing_step);
  EXPECT_FALSE(best.transport.solution.carries_emission);
  EXPECT_TRUE(best.transport.textures_at_points);
  EXPECT_TRUE(best.soft.shadows.has_receiver_plane);
  EXPECT_GE(best.atlas.padding_px, 2);
}

TEST(RayBundlesSettings, JacobiCountsItsBouncesFromTheFirstDirection) {
  const Settings settings =
      settings_of(test::parameters_of("ray-bundles", {"feed=jacobi", "direct_only=8"}));
  EXPECT_EQ(settings.transport.solution.direct_only, 0);
}

TEST(RayBundlesSettings, RefusesWhatIsNotThere) {
  EXPECT_EQ(tests::input_error_of([] { test::parameters_of("ray-bundles", {"backend=cuda"}); }),
            "test: parameter \"backend\" of ray-bundles cannot be \"cuda\"; accepted: one of "
            "auto, cpu, opengl");
  for (const char* other : {"backend=cpu", "transfer=gather", "feed=jacobi", "feed=stochastic",
                            "census=2", "glossy=chain", "final_glossy=bundles"}) {
    EXPECT_EQ(tests::input_error_of([&] {
                settings_of(test::parameters_of("ray-bundles", {"exchange=device", other}));
              }),
              "ray-bundles: exchange device; accepted with it: backend opengl, transfer scatter, "
              "feed growing_step or running_mean, census 0, glossy last_surface, final_glossy ray; "
              "or exchange cpu")
        << other;
  }
  EXPECT_NE(tests::input_error_of([] { test::parameters_of("ray-bundles", {"lines=3"}); }),
            "no error");
}

TEST(RayBundlesSettings, ClaimsDiffuseOfEitherPart) {
  EXPECT_EQ(claims_of(test::parameters_of("ray-bundles", {})),
            (Claims{Transport::diffuse, Part::all, std::nullopt}));
  EXPECT_EQ(claims_of(test::parameters_of("ray-bundles", {"part=indirect"})),
            (Claims{Transport::diffuse, Part::indirect, std::nullopt}));
}

}  // namespace
}  // namespace renderers::ray_bundles
