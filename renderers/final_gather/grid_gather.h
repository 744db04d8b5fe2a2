#pragma once

#include <cstdint>
#include <vector>

#include "renderers/final_gather/grid_anchors.h"
#include "renderers/final_gather/link_gather.h"
#include "renderers/final_gather/sender_transfer.h"
#include "renderers/final_gather/vertex_classes.h"

namespace renderers::final_gather {

/// Irradiance at surface points from the vertices of a grid.
///
///   H(x) = sum over v of lambda_v [around_v(n) + sum over s of B_s F* V*]
///
/// B_s what the sender sends, lambda_v the weights in the tetrahedron, F* and V* what the vertex
/// has stored if it interpolates them, or what is evaluated at x, once for all vertices that ask,
/// with sum lambda_v N_{v,s} samples. A sender that one vertex resamples and another interpolates
/// gets both, blended (Sec. 4.4.2), so that the result is continuous. Source: Scheel et al. 2002,
/// Sec. 4.4; the form as a partition of unity is ours.
class GridGather {
 public:
  /// Classifies all touched vertices. All must live as long as this.
  GridGather(const SenderTransfer& transfer, const GridAnchors& anchors,
             const VertexClassifier& classifier);

  GatheredLight at(const Receiver& receiver) const;
  /// Mean of the vertices' masking elevations at a point.
  double elevation(const glm::vec3& place) const;
  /// Mean of the vertices' thresholds at a point, cd/m2.
  double threshold_cd_m2(const glm::vec3& place) const;

  const std::vector<GridVertex>& vertices() const { return vertices_; }  ///< touched ones, in order
  std::int64_t memory_bytes() const;

 private:
  struct Request;
  const GridVertex* vertex(std::uint32_t index) const;
  void add_vertex(const GridVertex& vertex, float weight, const glm::vec3& normal,
                  std::vector<Request>& requests, GatheredLight& light) const;
  void resample(const Receiver& receiver, const Request* first, const Request* last,
                GatheredLight& light) const;

  const SenderTransfer& transfer_;
  const GridAnchors& anchors_;
  std::vector<GridVertex> vertices_;
  std::vector<std::uint32_t> slot_;  ///< per grid vertex, into vertices_; kNoElement: untouched
};

}  // namespace renderers::final_gather
