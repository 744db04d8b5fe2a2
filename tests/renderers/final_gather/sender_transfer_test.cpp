#include "renderers/final_gather/sender_transfer.h"

#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "renderers/element_hierarchy/form_factor.h"
#include "tests/renderers/element_hierarchy/hierarchy_fixture.h"

/// Transport from a sender to a point by fixed samples with a real number of them.
namespace renderers::test {
namespace {

using final_gather::Positions;
using final_gather::Receiver;
using final_gather::SenderTransfer;
using final_gather::Transfer;
using final_gather::TransferSettings;

/// A lamp of 2 x 2 m over a floor, with a screen between them that covers half the lamp.
SceneBuilder lamp_and_screen() {
  SceneBuilder builder;
  const int floor = builder.add_material(lambert(glm::vec3(0.5F)));
  const int lamp =
      builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(1.0F / std::numbers::pi_v<float>)));
  builder.add_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, floor);
  builder.add_quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, lamp);
  builder.add_quad({0, 1, -3}, {3, 0, 0}, {0, 0, 6}, floor);
  return builder;
}

Receiver floor_point(const SolvedScene& solved, float u, float v) {
  Receiver receiver;
  receiver.point = solved.rays.point_on_triangle(0, 0, {u, v});
  receiver.normal = {0, 1, 0};
  return receiver;
}

/// The lamp's first triangle as a sender.
std::uint32_t lamp_of(const SolvedScene& solved) {
  for (const std::uint32_t root : solved.tree().roots()) {
    if (solved.tree().at(root).object == 1 && !solved.tree().at(root).is_back) return root;
  }
  return 0;
}

TEST(SenderTransfer, SamplesConvergeToTheExactFormFactor) {
  const SceneBuilder builder = lamp_and_screen();
  const SolvedScene solved(builder.scene, solver_settings(200));
  const std::uint32_t lamp = lamp_of(solved);
  const Receiver receiver = floor_point(solved, 0.3F, 0.3F);
  const double expected = element_hierarchy::point_form_factor(
      receiver.point.position, receiver.normal, solved.tree().at(lamp).positions);
  for (const Positions positions : {Positions::random, Positions::r2}) {
    const SenderTransfer sampled(*solved.solution,
                                 {.points = {.positions = positions}, .is_exact = false});
    EXPECT_NEAR(sampled.form_factor(receiver, lamp, 4000.0).form_factor, expected, 0.01 * expected);
  }
  const SenderTransfer exact(*solved.solution, {});
  EXPECT_NEAR(exact.form_factor(receiver, lamp, 1.0).form_factor, expected, 1e-9);
  EXPECT_EQ(exact.form_factor(receiver, lamp, 9.0).visibility_rays, 0.0);
}

/// The irradiance of an unoccluded lamp of 1 W/m2 is its form factor.
TEST(SenderTransfer, AnOpenLampBringsItsFormFactor) {
  SceneBuilder builder = lamp_and_screen();
  builder.scene.objects.pop_back();
  const SolvedScene solved(builder.scene, solver_settings(200));
  const SenderTransfer transfer(*solved.solution, {});
  const Transfer whole = transfer.whole(floor_point(solved, 0.3F, 0.3F), lamp_of(solved), 7.5);
  EXPECT_EQ(whole.visibility, 1.0);
  EXPECT_NEAR(static_cast<double>(whole.irradiance.x), whole.form_factor, 1e-6);
  EXPECT_EQ(whole.visibility_rays, 8.0);
}

/// N and N + 1e-4 give nearly the same; rounded numbers of samples would not.
TEST(SenderTransfer, IsContinuousInTheNumberOfSamples) {
  const SceneBuilder builder = lamp_and_screen();
  const SolvedScene solved(builder.scene, solver_settings(200));
  const SenderTransfer transfer(*solved.solution, {});
  const std::uint32_t lamp = lamp_of(solved);
  double largest_step = 0.0;
  double largest_rounded = 0.0;
  for (int i = 0; i < 40; ++i) {
    Receiver receiver = floor_point(solved, 0.25F, 0.25F);
    receiver.point.position = {-0.9F + 0.045F * static_cast<float>(i), 0.0F, 0.1F};
    for (const double samples : {4.0, 9.0}) {
      const double here = transfer.whole(receiver, lamp, samples).visibility;
      const double near = transfer.whole(receiver, lamp, samples + 1e-4).visibility;
      const double rounded = transfer.whole(receiver, lamp, samples + 1.0).visibility;
      largest_step = std::max(largest_step, std::fabs(near - here));
      largest_rounded = std::max(largest_rounded, std::fabs(rounded - here));
    }
  }
  EXPECT_LT(largest_step, 1e-3);
  EXPECT_GT(largest_rounded, 0.02);
}

/// Along a penumbra the visibility of fixed samples takes N + 1 values (Sec. 5.3, Fig. 5).
TEST(SenderTransfer, FixedSamplesMakeAsManyStepsAsThereAreSamples) {
  const SceneBuilder builder = lamp_and_screen();
  const SolvedScene solved(builder.scene, solver_settings(200));
  const SenderTransfer transfer(*solved.solution, {});
  const std::uint32_t lamp = lamp_of(solved);
  std::set<int> counts;
  for (int i = 0; i < 400; ++i) {
    Receiver receiver = floor_point(solved, 0.25F, 0.25F);
    receiver.point.position = {-1.8F + 0.009F * static_cast<float>(i), 0.0F, 0.1F};
    const Transfer whole = transfer.whole(receiver, lamp, 16.0);
    counts.insert(static_cast<int>(std::lround(whole.visibility * 1000.0)));
  }
  // Kernel weights vary a little along the way: many values, few per sample.
  EXPECT_GE(counts.size(), 12U);
}

TEST(SenderTransfer, PositionsAreFixedUnlessAskedOtherwise) {
  const SceneBuilder builder = lamp_and_screen();
  const SolvedScene solved(builder.scene, solver_settings(200));
  const std::uint32_t lamp = lamp_of(solved);
  Receiver first = floor_point(solved, 0.4F, 0.2F);
  Receiver second = first;
  second.ray_number = 1;
  const SenderTransfer fixed(*solved.solution, {.points = {}, .is_exact = false});
  EXPECT_EQ(fixed.whole(first, lamp, 5.0).irradiance, fixed.whole(second, lamp, 5.0).irradiance);
  const SenderTransfer drawn(
      *solved.solution, {.points = {}, .reuse = final_gather::Reuse::per_pixel, .is_exact = false});
  EXPECT_NE(drawn.whole(first, lamp, 5.0).irradiance, drawn.whole(second, lamp, 5.0).irradiance);
}

}  // namespace
}  // namespace renderers::test
