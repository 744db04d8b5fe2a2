#pragma once

#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/clustered_visibility/area_visibility.h"
#include "renderers/clustered_visibility/light_clusters.h"
#include "tests/renderers/clustered_visibility/convolution_oracle.h"

/// Comparisons in an area light's map one by one, in double precision: one test, and percentage-
/// closer soft shadows (Fernando 2005, recalled) with the widths of Dong et al. 2009, Sec. 4.2.
namespace test_clustered_visibility {

namespace cv = renderers::clustered_visibility;

class CloserOracle {
 public:
  /// @param map     depths in the light's units; what lies beyond kFarDepth there counts as that
  /// @param near_m  height of the map's centre above the light
  CloserOracle(const cv::AreaVisibilitySettings& settings, const cv::AreaLight& area, float near_m,
               DepthMap map);

  /// Share of the light seen; nothing where rounding may decide a comparison or a box's texels.
  /// @param normal  unit length
  std::optional<double> visibility(const glm::vec3& position, const glm::vec3& normal) const;

 private:
  struct Receiver {
    glm::dvec3 local{0.0};  ///< in the map's frame, m
    glm::dvec3 normal{0.0};
    glm::dvec2 place{0.0};  ///< in the unit disc
    double distance_m = 0.0;
    double cosine = 0.0;  ///< at the light
  };
  /// What texels of a box say.
  struct Texels {
    double blocked = 0.0;    ///< share
    double blocker_m = 0.0;  ///< mean distance of those that block
    bool is_decided = true;
  };

  Receiver receiver(const glm::vec3& position, const glm::vec3& normal) const;
  double compared_m(const glm::ivec2& texel, const Receiver& receiver) const;
  Texels look_at(const glm::ivec2& least, const glm::ivec2& greatest,
                 const Receiver& receiver) const;
  Texels look_in_box(const Receiver& receiver, double width_uv) const;
  double width_uv(double angle_rad, const Receiver& receiver) const;

  cv::AreaVisibilitySettings settings_;
  cv::AreaLight area_;
  double near_m_;
  DepthMap map_;
};

}  // namespace test_clustered_visibility
