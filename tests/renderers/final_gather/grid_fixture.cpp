#include "tests/renderers/final_gather/grid_fixture.h"

#include <cmath>

namespace renderers::test {

RenderJob small_job(const scene::Scene& scene) {
  RenderJob job;
  job.width_px = 16;
  job.height_px = 16;
  job.camera = scene.camera;
  return job;
}

GridScene::GridScene(const scene::Scene& scene, const final_gather::ClassSettings& settings,
                     const final_gather::PerceptionSettings& perception, std::size_t links)
    : rays(scene, timer, ray_tracing::RayQueries::all_hits),
      solution(element_hierarchy::solve_radiosity(rays, solver_settings(links), timer)),
      shown(*solution, element_hierarchy::Shading::smooth),
      job(small_job(scene)),
      samples(rays, job, {.camera_rays = 1, .border_rays = 1}),
      view(final_gather::preview_luminance(rays, shown, job, preview_rays), perception),
      seen(final_gather::camera_anchors(*solution->tree, samples)),
      anchors(final_gather::grid_around(seen, job, {.vertices = 150}), seen,
              std::vector<bool>(seen.size(), true)),
      transfer(*solution, {}),
      classes(transfer, view, settings),
      classifier(classes, anchors, final_gather::HitRule::surface),
      gather(transfer, anchors, classifier) {}

double relative_difference(const perception::Image& image, const perception::Image& truth) {
  double difference = 0.0;
  double size = 0.0;
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    difference += std::pow(static_cast<double>(image.pixels[i] - truth.pixels[i]), 2);
    size += std::pow(static_cast<double>(truth.pixels[i]), 2);
  }
  return std::sqrt(difference / size);
}

}  // namespace renderers::test
