#include "renderers/element_hierarchy/surface_pieces.h"

#include <gtest/gtest.h>

#include "perception/base/parallel.h"
#include "tests/renderers/element_hierarchy/hierarchy_fixture.h"

namespace renderers::test {
namespace {

using element_hierarchy::SurfacePieces;

/// A large floor under many small boxes, with a lamp.
SceneBuilder floor_with_boxes() {
  SceneBuilder builder;
  const int gray = builder.add_material(lambert(glm::vec3(0.6F)));
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(10.0F)));
  builder.add_quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, gray);
  builder.add_quad({-0.5F, 2, -0.5F}, {1, 0, 0}, {0, 0, 1}, lamp);
  for (int i = 0; i < 100; ++i) {
    const glm::vec3 low(-2.5F + 0.5F * static_cast<float>(i % 10), 0.2F,
                        -2.5F + 0.5F * static_cast<float>(i / 10));
    builder.add_box(low, low + glm::vec3(0.2F), gray, false);
  }
  return builder;
}

TEST(SurfacePieces, CutWhatIsLargerAndFindItsPlaces) {
  const SceneBuilder builder = floor_with_boxes();
  StageTimer timer;
  const ray_tracing::RayScene rays(builder.scene, timer);
  const SurfacePieces whole(rays, 0.0);
  EXPECT_EQ(whole.count(), 2U + 2U + 100U * 12U);
  const SurfacePieces pieces(rays, 4.0);
  EXPECT_GT(pieces.count(), whole.count() + 100U);
  double area_m2 = 0.0;
  float largest_m2 = 0.0F;
  for (std::size_t i = 0; i < pieces.count(); ++i) {
    const SurfacePieces::Piece piece = pieces.at(i);
    area_m2 += static_cast<double>(piece.area_m2);
    largest_m2 = std::max(largest_m2, piece.area_m2);
    // Nearer to one corner than to the others, so that a turned piece is noticed.
    const glm::vec2 place =
        0.5F * piece.corners[0] + 0.3F * piece.corners[1] + 0.2F * piece.corners[2];
    const SurfacePieces::Place found = pieces.place_of(piece.object, piece.triangle, place);
    ASSERT_EQ(found.piece, i);
    EXPECT_NEAR(found.weights.x, 0.5F, 1e-3F);
    EXPECT_NEAR(found.weights.y, 0.3F, 1e-3F);
    EXPECT_NEAR(found.weights.z, 0.2F, 1e-3F);
  }
  const double expected_m2 = 36.0 + 1.0 + 100.0 * 6.0 * 0.04;
  EXPECT_NEAR(area_m2, expected_m2, 1e-4 * expected_m2);
  EXPECT_LE(static_cast<double>(largest_m2),
            4.0 * expected_m2 / static_cast<double>(whole.count()));
}

/// More sides than one thread's share of any loop.
TEST(SurfacePieces, ManySidesGiveTheSameBytesWithOneAndTwoThreads) {
  const SceneBuilder builder = floor_with_boxes();
  std::vector<std::vector<glm::vec3>> radiosities;
  for (const int threads : {1, 2}) {
    const base::ThreadLimit limit(threads);
    const SolvedScene solved(builder.scene, solver_settings(3000));
    EXPECT_GT(solved.tree().roots().size(), 1000U);
    radiosities.push_back(solved.solution->field->radiosity());
  }
  EXPECT_EQ(radiosities[0], radiosities[1]);
}

/// A floor below two closed rooms, one with a lamp: its light stays there.
TEST(SurfacePieces, AFloorCarriesNoLightThroughAWall) {
  SceneBuilder builder;
  const int gray = builder.add_material(lambert(glm::vec3(0.6F)));
  const int lamp = builder.add_material(lambert(glm::vec3(0.0F), glm::vec3(10.0F)));
  builder.add_box({-4, 0, -2}, {4, 3, 2}, gray, true);
  const auto wall = static_cast<int>(builder.scene.objects.size());
  builder.add_box({-0.1F, -0.1F, -2.1F}, {0.1F, 3.1F, 2.1F}, gray, false);
  builder.add_quad({-2.5F, 2.9F, -0.5F}, {1, 0, 0}, {0, 0, 1}, lamp);
  for (int i = 0; i < 100; ++i) {  // so that the floor is large
    const glm::vec3 low(0.5F + 0.3F * static_cast<float>(i % 10), 0.5F,
                        -1.5F + 0.3F * static_cast<float>(i / 10));
    builder.add_box(low, low + glm::vec3(0.1F), gray, false);
  }
  const SolvedScene solved(builder.scene, solver_settings(4000));
  double here = 0.0;
  double there = 0.0;
  for (std::size_t i = 0; i < solved.elements().size(); ++i) {
    const element_hierarchy::Element& element = solved.elements()[i];
    if (!element.is_leaf() || static_cast<int>(element.object) == wall) continue;
    const auto light =
        static_cast<double>(element.area_m2 * solved.solution->field->irradiance()[i].x);
    (0.5F * (element.box_min.x + element.box_max.x) < 0.0F ? here : there) += light;
  }
  EXPECT_GT(here, 10.0);
  EXPECT_LT(there, 0.02 * here);
}

}  // namespace
}  // namespace renderers::test
