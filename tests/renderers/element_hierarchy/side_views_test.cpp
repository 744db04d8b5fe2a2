#include "renderers/element_hierarchy/side_views.h"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/renderers/element_hierarchy/hierarchy_fixture.h"

/// Light of clusters: no power is lost, and none goes where nothing is seen.
namespace renderers::test {
namespace {

using element_hierarchy::Element;
using element_hierarchy::SideViews;

/// Power of an irradiance on all leaves.
double power_w(const SolvedScene& solved, const std::vector<glm::vec3>& irradiance) {
  double sum = 0.0;
  for (std::size_t i = 0; i < solved.elements().size(); ++i) {
    const Element& element = solved.elements()[i];
    if (element.is_leaf()) sum += static_cast<double>(element.area_m2 * irradiance[i].x);
  }
  return sum;
}

TEST(SideViews, SharingOutKeepsThePower) {
  const SceneBuilder builder = closed_room();
  const SolvedScene solved(builder.scene, solver_settings(1000));
  std::vector<glm::vec3> gathered(solved.elements().size(), glm::vec3(0.0F));
  double expected_w = 0.0;
  for (std::size_t i = 0; i < gathered.size(); ++i) {
    if (solved.elements()[i].is_patch) continue;
    gathered[i] = glm::vec3(1.0F + static_cast<float>(i % 5));
    expected_w += static_cast<double>(solved.elements()[i].area_m2 * gathered[i].x);
  }
  const std::vector<glm::vec3> shared = solved.solution->views->push(gathered);
  EXPECT_NEAR(power_w(solved, shared), expected_w, 1e-4 * expected_w);
  // Not evenly: a side that sees nothing of it gets none.
  const Range range = leaf_range(solved, shared);
  EXPECT_LT(range.least, 0.8 * range.greatest);
}

TEST(SideViews, ClustersSendWhatLeavesThem) {
  const SceneBuilder builder = closed_room();
  const SolvedScene solved(builder.scene, solver_settings(64));
  // All alike: means of any weights are the value.
  const std::vector<glm::vec3> even(solved.elements().size(), glm::vec3(2.0F));
  const SideViews::Sent sent = solved.solution->views->sent(even);
  for (std::size_t i = 0; i < even.size(); ++i) {
    EXPECT_NEAR(sent.out[i].x, 2.0F, 1e-5F);
    EXPECT_NEAR(sent.inside[i].x, 2.0F, 1e-5F);
  }
}

/// A floor lamp under a lid: the lid's underside shares a cluster with its upper side, which sees
/// the dark half of the room alone.
TEST(SideViews, SidesThatLookAwayFromTheLampStayDarker) {
  SceneBuilder builder;
  const int gray = builder.add_material(lambert(glm::vec3(0.1F)));
  const int lamp = builder.add_material(lambert(glm::vec3(0.1F), glm::vec3(1.0F)));
  builder.add_box(glm::vec3(-2.0F), glm::vec3(2.0F), gray, true);
  const int lid = static_cast<int>(builder.scene.objects.size());
  builder.add_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, gray);
  builder.add_quad({-1, -1.5F, -1}, {0, 0, 2}, {2, 0, 0}, lamp);
  element_hierarchy::SolverSettings settings = solver_settings(64);
  double ratio[2] = {};
  for (const int i : {0, 1}) {
    settings.shares_by_views = i == 1;
    const SolvedScene solved(builder.scene, settings);
    double up = 0.0;
    double down = 0.0;
    for (std::size_t e = 0; e < solved.elements().size(); ++e) {
      const Element& element = solved.elements()[e];
      if (!element.is_leaf() || static_cast<int>(element.object) != lid) continue;
      const auto light =
          static_cast<double>(element.area_m2 * solved.solution->field->irradiance()[e].x);
      (element.normal.y > 0.0F ? up : down) += light;
    }
    ratio[i] = up / down;
  }
  EXPECT_LT(ratio[1], ratio[0]);
  EXPECT_LT(ratio[1], 0.2);
}

}  // namespace
}  // namespace renderers::test
