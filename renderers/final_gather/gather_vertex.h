#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "renderers/final_gather/directional_irradiance.h"

namespace renderers::final_gather {

/// A sender as a vertex sees it.
struct SenderRecord {
  std::uint32_t sender = 0;
  bool resamples_form_factor = false;
  bool resamples_visibility = false;
  float visibility = 0.0F;    ///< mean over the neighbourhood
  glm::vec3 radiosity{0.0F};  ///< W/m2, of what is seen of the sender
  /// With the receiver's cosine, of vertices of a surface, whose normal is known; else below 0.
  float form_factor = -1.0F;
  /// Of vertices in space: mean of omega d / pi, d towards the sender; B times its product with a
  /// normal is irradiance.
  glm::vec3 vector_form_factor{0.0F};
  float form_factor_samples = 0.0F;
  float visibility_samples = 0.0F;
};

/// What a vertex of the grid or of a surface knows.
struct GatherVertex {
  std::vector<SenderRecord> records;  ///< by sender
  DirectionalIrradiance around;       ///< from senders that contain the vertex, of the grid
  glm::vec3 near_irradiance{0.0F};    ///< W/m2, from the same, of a surface
  double threshold_cd_m2 = 0.0;       ///< least visible step, pooled over the adjacent cells
  double base_threshold_cd_m2 = 0.0;  ///< without masking, the mean
  double elevation = 1.0;             ///< masking, pooled
  double weak_share = 0.0;   ///< of the pixels that mask less than half of what the vertex says
  double world_cd_m2 = 0.0;  ///< of the preview, the mean
  std::uint64_t visibility_rays = 0;
  std::uint64_t form_factor_samples = 0;
  std::uint32_t senders = 0;
  std::uint32_t near_senders = 0;
};

}  // namespace renderers::final_gather
