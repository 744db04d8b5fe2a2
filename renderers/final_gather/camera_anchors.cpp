#include "renderers/final_gather/camera_anchors.h"

#include <glm/geometric.hpp>

#include "perception/base/parallel.h"

namespace renderers::final_gather {

std::vector<Anchor> camera_anchors(const element_hierarchy::ElementTree& tree,
                                   const CameraSamples& samples) {
  std::vector<std::size_t> first(samples.pixel_count() + 1, 0);
  for (std::size_t i = 0; i < samples.pixel_count(); ++i) {
    first[i + 1] = first[i] + static_cast<std::size_t>(samples.count(i));
  }
  std::vector<Anchor> anchors(first.back());
  for (Anchor& anchor : anchors) anchor.leaf = element_hierarchy::kNoElement;
  base::parallel_for(samples.pixel_count(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t pixel = begin; pixel < end; ++pixel) {
      for (int i = 0; i < samples.count(pixel); ++i) {
        const ray_tracing::Ray ray = samples.ray(pixel, i);
        ray_tracing::Hit hit;
        if (!tree.rays().intersect(ray, hit)) continue;
        Anchor& anchor = anchors[first[pixel] + static_cast<std::size_t>(i)];
        anchor.leaf = tree.leaf_at(hit, -ray.direction);
        anchor.place = hit.position;
        anchor.towards = -ray.direction;
        anchor.object = hit.object;
        anchor.triangle = hit.triangle;
        anchor.barycentrics = hit.barycentrics;
        anchor.pixel = static_cast<std::uint32_t>(pixel);
        anchor.weight = 1.0F / static_cast<float>(samples.count(pixel));
        anchor.is_back = glm::dot(hit.geometric_normal, ray.direction) > 0.0F;
      }
    }
  });
  std::erase_if(anchors,
                [](const Anchor& anchor) { return anchor.leaf == element_hierarchy::kNoElement; });
  return anchors;
}

}  // namespace renderers::final_gather
