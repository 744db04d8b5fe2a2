#pragma once

#include <cstdint>
#include <vector>

#include "renderers/final_gather/record_blend.h"
#include "renderers/final_gather/surface_classes.h"

namespace renderers::final_gather {

/// Irradiance at points of surfaces from the vertices of their patches, by `RecordBlend`.
class SurfaceGather {
 public:
  /// Classifies all vertices. All must live as long as this.
  SurfaceGather(const SenderTransfer& transfer, const SurfaceVertices& surface,
                const SurfaceClassifier& classifier);

  /// Vertices around a point; null where no camera ray came near.
  /// @param towards  any length, which side of the surface
  std::vector<WeightedVertex> around(const ray_tracing::SurfacePoint& point,
                                     const glm::vec3& towards) const;
  GatheredLight at(const Receiver& receiver) const {
    return blend_.at(receiver, around(receiver.point, receiver.normal));
  }

  const std::vector<GatherVertex>& vertices() const { return vertices_; }
  std::int64_t memory_bytes() const { return final_gather::memory_bytes(vertices_); }

 private:
  RecordBlend blend_;
  const SurfaceVertices& surface_;
  std::vector<GatherVertex> vertices_;
};

}  // namespace renderers::final_gather
