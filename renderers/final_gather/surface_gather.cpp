#include "renderers/final_gather/surface_gather.h"

#include "perception/base/parallel.h"

namespace renderers::final_gather {

SurfaceGather::SurfaceGather(const SenderTransfer& transfer, const SurfaceVertices& surface,
                             const SurfaceClassifier& classifier)
    : blend_(transfer), surface_(surface), vertices_(surface.count()) {
  base::parallel_for(vertices_.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) vertices_[i] = classifier.classify(i);
  });
}

std::vector<WeightedVertex> SurfaceGather::around(const ray_tracing::SurfacePoint& point,
                                                  const glm::vec3& towards) const {
  std::vector<WeightedVertex> found;
  for (const auto& [site, weight] : surface_.around(point, towards)) {
    const bool is_known = site != element_hierarchy::kNoElement;
    found.push_back({is_known ? &vertices_[site] : nullptr, weight});
  }
  return found;
}

}  // namespace renderers::final_gather
