#pragma once

#include <memory>
#include <vector>

#include "renderers/final_gather/grid_gather.h"
#include "tests/renderers/element_hierarchy/hierarchy_fixture.h"

namespace renderers::test {

/// A solved scene and what the grid gather makes of one view of it. The scene must live as long.
struct GridScene {
  GridScene(const scene::Scene& scene, const final_gather::ClassSettings& settings,
            const final_gather::PerceptionSettings& perception = {}, std::size_t links = 1000);

  StageTimer timer;
  ray_tracing::RayScene rays;
  std::unique_ptr<element_hierarchy::Solution> solution;
  element_hierarchy::ShownLight shown;
  RenderJob job;
  final_gather::CameraSamples samples;
  std::uint64_t preview_rays = 0;
  final_gather::ViewPerception view;
  std::vector<final_gather::Anchor> seen;
  final_gather::GridAnchors anchors;
  final_gather::SenderTransfer transfer;
  final_gather::SenderClasses classes;
  final_gather::VertexClassifier classifier;
  final_gather::GridGather gather;
};

/// 16 x 16 pixels from the scene's camera.
RenderJob small_job(const scene::Scene& scene);

/// Root of the sum of squared differences over that of the truth's squares.
double relative_difference(const perception::Image& image, const perception::Image& truth);

}  // namespace renderers::test
