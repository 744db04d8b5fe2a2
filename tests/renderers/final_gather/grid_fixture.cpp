#include "tests/renderers/final_gather/grid_fixture.h"

namespace renderers::test {

RenderJob small_job(const scene::Scene& scene) {
  RenderJob job;
  job.width_px = 16;
  job.height_px = 16;
  job.camera = scene.camera;
  return job;
}

GridScene::GridScene(const scene::Scene& scene, const final_gather::ClassSettings& classes,
                     const final_gather::PerceptionSettings& perception, std::size_t links)
    : rays(scene, timer, ray_tracing::RayQueries::all_hits),
      solution(element_hierarchy::solve_radiosity(rays, solver_settings(links), timer)),
      shown(*solution, element_hierarchy::Shading::smooth),
      job(small_job(scene)),
      samples(rays, job, {.camera_rays = 1, .border_rays = 1}),
      view(final_gather::preview_luminance(rays, shown, job, preview_rays), perception),
      anchors(final_gather::GridAnchors::make(*solution->tree, samples, job, {.vertices = 150})),
      transfer(*solution, {}),
      classifier(transfer, *anchors, view, classes),
      gather(transfer, *anchors, classifier) {}

}  // namespace renderers::test
