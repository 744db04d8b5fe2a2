#pragma once

#include <cstdint>
#include <vector>

#include "renderers/final_gather/sender_classes.h"
#include "renderers/final_gather/surface_vertices.h"

namespace renderers::final_gather {

/// Where the visibility that a vertex of a surface stores comes from.
enum class VertexVisibility {
  links,  ///< what the links of the patches around say (Scheel et al. 2001)
  rays    ///< rays from these patches; ours
};

struct SurfaceViewpoint {
  glm::vec3 camera{0.0F};
  glm::vec3 forward{0.0F};      ///< unit length
  double pixels_per_rad = 0.0;  ///< at the picture's centre
};

/// Collects and classifies the senders of a vertex of a surface: of all patches around it.
///
/// Form factors are those at the vertex, with the receiver's cosine, their spread that over the
/// other corners of the patches around. Senders that contain the vertex share `containing_rays`
/// cosine-distributed rays from these patches.
/// Source: Scheel, Stamminger, Seidel 2001, "Thrifty Final Gather for Radiosity", of which only
/// what Scheel et al. 2002, Secs. 2 and 4.5, say was at hand: senders classified per vertex, form
/// factors recomputed there and visibilities not.
class SurfaceClassifier {
 public:
  /// All must live as long as this.
  SurfaceClassifier(const SenderClasses& classes, const SurfaceVertices& surface,
                    VertexVisibility visibility, const SurfaceViewpoint& viewpoint);

  GatherVertex classify(std::size_t site) const;

 private:
  Surrounding surrounding_of(std::size_t site) const;
  /// The vertex first, then corners of the patches around.
  std::vector<Receiver> receivers_of(std::size_t site) const;
  Spread spread_of(const Surrounding& around, const std::vector<Receiver>& receivers,
                   const Sender& sender, int count, GatherVertex& vertex) const;
  void add_rays(const Surrounding& around, const Sender& sender, int count, Spread& spread,
                GatherVertex& vertex) const;
  void add_near(const Surrounding& around, const std::vector<std::uint32_t>& senders,
                std::size_t site, GatherVertex& vertex) const;

  const SenderClasses& classes_;
  const SenderTransfer& transfer_;
  const SurfaceVertices& surface_;
  VertexVisibility visibility_;
  SurfaceViewpoint viewpoint_;
};

}  // namespace renderers::final_gather
