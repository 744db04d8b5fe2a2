#pragma once

#include <cstdint>
#include <vector>

#include "renderers/final_gather/grid_anchors.h"
#include "renderers/final_gather/record_blend.h"
#include "renderers/final_gather/vertex_classes.h"

namespace renderers::final_gather {

/// Irradiance at surface points from the vertices of a grid, by `RecordBlend`.
class GridGather {
 public:
  /// Classifies all touched vertices. All must live as long as this.
  GridGather(const SenderTransfer& transfer, const GridAnchors& anchors,
             const VertexClassifier& classifier);

  /// Vertices around a place; null where no camera ray came near.
  std::vector<WeightedVertex> around(const glm::vec3& place) const;
  GatheredLight at(const Receiver& receiver) const {
    return blend_.at(receiver, around(receiver.point.position));
  }

  const std::vector<GatherVertex>& vertices() const { return vertices_; }  ///< touched, in order
  std::int64_t memory_bytes() const;

 private:
  const GatherVertex* vertex(std::uint32_t index) const;

  RecordBlend blend_;
  const GridAnchors& anchors_;
  std::vector<GatherVertex> vertices_;
  std::vector<std::uint32_t> slot_;  ///< per grid vertex, into vertices_; kNoElement: untouched
};

}  // namespace renderers::final_gather
