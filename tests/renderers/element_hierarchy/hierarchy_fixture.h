#pragma once

#include <memory>
#include <vector>

#include "renderers/element_hierarchy/radiosity_solver.h"
#include "renderers/ray_tracing/ray_scene.h"
#include "tests/renderers/scene_builder.h"

namespace renderers::test {

/// A solved scene with what it rests on. The scene must live as long.
struct SolvedScene {
  SolvedScene(const scene::Scene& scene, const element_hierarchy::SolverSettings& settings);

  StageTimer timer;
  ray_tracing::RayScene rays;
  std::unique_ptr<element_hierarchy::Solution> solution;

  const element_hierarchy::ElementTree& tree() const { return *solution->tree; }
  const std::vector<element_hierarchy::Element>& elements() const { return tree().elements(); }
};

/// Settings with a budget of links, converged to 1e-5.
element_hierarchy::SolverSettings solver_settings(std::size_t link_budget);

/// Mean by area over the leaf patches of an object of a value per element, first channel.
/// @param object  -1: all
double leaf_mean(const SolvedScene& solved, const std::vector<glm::vec3>& values, int object = -1);
/// Extremes of the same.
struct Range {
  double least;
  double greatest;
};
Range leaf_range(const SolvedScene& solved, const std::vector<glm::vec3>& values);

/// A room with a shining ceiling, a block and coloured walls: closed, all light stays inside.
SceneBuilder closed_room();
/// The same with a point light.
SceneBuilder lit_room();

}  // namespace renderers::test
