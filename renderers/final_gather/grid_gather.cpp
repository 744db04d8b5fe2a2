#include "renderers/final_gather/grid_gather.h"

#include "perception/base/parallel.h"

namespace renderers::final_gather {

using element_hierarchy::kNoElement;

GridGather::GridGather(const SenderTransfer& transfer, const GridAnchors& anchors,
                       const VertexClassifier& classifier)
    : blend_(transfer), anchors_(anchors), vertices_(anchors.touched().size()) {
  slot_.assign(anchors.grid().size().vertex_count(), kNoElement);
  for (std::uint32_t i = 0; i < anchors.touched().size(); ++i) slot_[anchors.touched()[i]] = i;
  base::parallel_for(vertices_.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      vertices_[i] = classifier.classify(anchors.touched()[i]);
    }
  });
}

const GatherVertex* GridGather::vertex(std::uint32_t index) const {
  return slot_[index] == kNoElement ? nullptr : &vertices_[slot_[index]];
}

std::vector<WeightedVertex> GridGather::around(const glm::vec3& place) const {
  const GridBlend blend = anchors_.grid().blend(place);
  std::vector<WeightedVertex> found;
  for (std::size_t i = 0; i < blend.count; ++i) {
    found.push_back({vertex(blend.vertices[i]), blend.weights[i]});
  }
  return found;
}

std::int64_t GridGather::memory_bytes() const {
  return final_gather::memory_bytes(vertices_) +
         static_cast<std::int64_t>(slot_.capacity() * sizeof(std::uint32_t));
}

}  // namespace renderers::final_gather
