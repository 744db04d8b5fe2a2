#include "tests/renderers/element_hierarchy/hierarchy_fixture.h"

#include <algorithm>
#include <limits>

namespace renderers::test {

using element_hierarchy::Element;

SolvedScene::SolvedScene(const scene::Scene& scene,
                         const element_hierarchy::SolverSettings& settings)
    : rays(scene, timer), solution(element_hierarchy::solve_radiosity(rays, settings, timer)) {}

element_hierarchy::SolverSettings solver_settings(std::size_t link_budget) {
  element_hierarchy::SolverSettings settings;
  settings.refinement.link_budget = link_budget;
  settings.convergence = 1e-5;
  return settings;
}

double leaf_mean(const SolvedScene& solved, const std::vector<glm::vec3>& values, int object) {
  double sum = 0.0;
  double area_m2 = 0.0;
  for (std::size_t i = 0; i < solved.elements().size(); ++i) {
    const Element& element = solved.elements()[i];
    if (!element.is_patch || !element.is_leaf()) continue;
    if (object >= 0 && static_cast<int>(element.object) != object) continue;
    sum += static_cast<double>(element.area_m2) * static_cast<double>(values[i].x);
    area_m2 += static_cast<double>(element.area_m2);
  }
  return sum / area_m2;
}

Range leaf_range(const SolvedScene& solved, const std::vector<glm::vec3>& values) {
  Range range{std::numeric_limits<double>::infinity(), 0.0};
  for (std::size_t i = 0; i < solved.elements().size(); ++i) {
    if (!solved.elements()[i].is_leaf()) continue;
    range.least = std::min(range.least, static_cast<double>(values[i].x));
    range.greatest = std::max(range.greatest, static_cast<double>(values[i].x));
  }
  return range;
}

SceneBuilder closed_room() {
  SceneBuilder builder;
  const int white = builder.add_material(lambert(glm::vec3(0.7F)));
  const int red = builder.add_material(lambert({0.6F, 0.2F, 0.1F}));
  const int lamp = builder.add_material(lambert(glm::vec3(0.3F), glm::vec3(1.0F)));
  builder.add_quad({-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, white);
  builder.add_quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, lamp);
  builder.add_quad({-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, white);
  builder.add_quad({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, white);
  builder.add_quad({-1, -1, -1}, {0, 2, 0}, {0, 0, 2}, red);
  builder.add_quad({1, -1, -1}, {0, 0, 2}, {0, 2, 0}, white);
  builder.add_box({0.0F, -0.9F, 0.1F}, {0.5F, -0.3F, 0.6F}, white, false);
  builder.look({0.1F, 0.0F, -0.95F}, {0, -0.1F, 1}, 75.0F);
  return builder;
}

SceneBuilder lit_room() {
  SceneBuilder builder = closed_room();
  builder.add_point_light({-0.5F, 0.3F, -0.2F}, glm::vec3(0.4F));
  return builder;
}

}  // namespace renderers::test
