#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "renderers/clustered_visibility/area_visibility.h"
#include "renderers/clustered_visibility/light_clusters.h"
#include "renderers/many_lights/surface_image.h"
#include "renderers/opengl/context.h"
#include "renderers/opengl/gpu_scene.h"
#include "renderers/scene/scene.h"
#include "tests/renderers/clustered_visibility/area_visibility_oracle.h"

namespace test_clustered_visibility {

/// An area light over a scene, its exact shadow map on the device, and what receivers see of it.
class AreaBench {
 public:
  /// @param area  with `far_depth` at a distance that holds the scene
  AreaBench(std::shared_ptr<renderers::opengl::Context> context,
            const renderers::scene::Scene& scene, const cv::AreaLight& area, int map_px);

  /// Share of the light that each pixel sees, by `show_visibility`.
  std::vector<double> visibility(const renderers::many_lights::SurfaceImage& surfaces,
                                 const cv::AreaVisibilitySettings& settings,
                                 const cv::ConvolutionSettings& convolution) const;
  /// The same of one receiver by the oracle, from the device's depths; see there.
  std::optional<double> oracle_visibility(const AreaVisibilityOracle& oracle,
                                          const glm::vec3& position, const glm::vec3& normal) const;
  /// Depths of the map in its units.
  DepthMap depth_map() const;
  const cv::AreaLight& area_light() const { return area_; }
  float near_m() const { return maps_.near_m(); }

 private:
  std::shared_ptr<renderers::opengl::Context> context_;
  cv::AreaLight area_;
  renderers::opengl::Buffer lights_;
  renderers::shadow_maps::HemisphereMaps maps_;
};

/// A square light that looks down.
/// @param farthest_m  distance of depth kFarDepth
cv::AreaLight light_above(const glm::vec3& position, float size_m, float farthest_m);

}  // namespace test_clustered_visibility
