#pragma once

#include <span>
#include <vector>

#include "renderers/final_gather/gather_vertex.h"
#include "renderers/final_gather/link_gather.h"
#include "renderers/final_gather/sender_transfer.h"

namespace renderers::final_gather {

/// A vertex that takes part at a point.
struct WeightedVertex {
  const GatherVertex* vertex = nullptr;
  float weight = 0.0F;
};

/// Irradiance at a point between vertices.
///
///   H(x) = sum over v of lambda_v [around_v(n) + sum over s of B_s F* V*]
///
/// B_s what the sender sends, lambda_v the weights of the vertices, F* and V* what the vertex has
/// stored if it interpolates them, or what is evaluated at x, once for all vertices that ask, with
/// sum lambda_v N_{v,s} samples. A sender that one vertex resamples and another interpolates gets
/// both, blended (Sec. 4.4.2), so that the result is continuous. Source: Scheel et al. 2002,
/// Sec. 4.4; the form as a partition of unity is ours.
class RecordBlend {
 public:
  /// @param transfer  must live as long as this
  explicit RecordBlend(const SenderTransfer& transfer) : transfer_(transfer) {}

  GatheredLight at(const Receiver& receiver, std::span<const WeightedVertex> vertices) const;

 private:
  struct Request;
  struct Asked;
  void add_vertex(const WeightedVertex& vertex, const glm::vec3& normal,
                  std::vector<Request>& requests, GatheredLight& light) const;
  /// @param requests  by sender  @return one for each sender
  std::vector<Asked> senders_of(std::span<const Request> requests, GatheredLight& light) const;
  void resample(const Receiver& receiver, const Asked& asked, const Transfer& exact,
                GatheredLight& light) const;

  const SenderTransfer& transfer_;
};

/// Mean masking elevation of vertices, 1 for those that are missing.
double mean_elevation(std::span<const WeightedVertex> vertices);
/// Mean threshold of vertices, cd/m2, 0 for those that are missing.
double mean_threshold_cd_m2(std::span<const WeightedVertex> vertices);
/// Bytes of vertices and their records.
std::int64_t memory_bytes(const std::vector<GatherVertex>& vertices);

}  // namespace renderers::final_gather
