#pragma once

#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "renderers/clustered_visibility/area_visibility.h"
#include "renderers/clustered_visibility/light_clusters.h"
#include "tests/renderers/clustered_visibility/convolution_oracle.h"

/// The share of an area light that a receiver sees by filtered shadow maps, in double precision
/// from the maps' depths: kernels are lists of texels and weights.
namespace test_clustered_visibility {

namespace cv = renderers::clustered_visibility;

/// Weights of texels in a trilinear lookup of levels of means.
/// @param level  any, at most that of a single texel counts
Kernel level_kernel(const DepthMap& map, const glm::dvec2& center_uv, double level);

/// A receiver as the map sees it.
struct SeenReceiver {
  glm::dvec2 uv{0.0};
  double radius = 0.0;  ///< 0 on the axis, 1 at the horizon
  double distance_m = 0.0;
  double cosine = 0.0;           ///< at the light
  double receiver_cosine = 0.0;  ///< of its normal, without sign
};
/// @param near_m  of the maps: their centre's height above the light
SeenReceiver seen_from(const cv::AreaLight& area, float near_m, const glm::vec3& position,
                       const glm::vec3& normal);

class AreaVisibilityOracle {
 public:
  /// @param settings     test cssm or msm
  /// @param convolution  of cssm
  AreaVisibilityOracle(const cv::AreaVisibilitySettings& settings,
                       const cv::ConvolutionSettings& convolution, DepthMap map)
      : settings_(settings),
        convolution_(convolution),
        series_{convolution.terms, double{settings.damping}},
        map_(std::move(map)) {}

  /// Nothing near the step at which blockers are taken for none.
  std::optional<double> visibility(const cv::AreaLight& area, const SeenReceiver& seen) const;

 private:
  double width(double angle_rad, const SeenReceiver& seen) const;
  /// What the receiver's plane rises within half a kernel, in its depths.
  double rise(const SeenReceiver& seen, double kernel_width) const;
  Kernel kernel(const SeenReceiver& seen, double kernel_width) const;
  std::optional<double> blocker_depth(const SeenReceiver& seen, double kernel_width,
                                      double depth) const;
  std::optional<double> series_blocker(const SeenReceiver& seen, double kernel_width,
                                       double depth) const;
  /// Mass of blockers and their sum of depths.
  struct Blockers {
    double mass = 0.0;
    double depths = 0.0;
  };
  /// @param reach  of the receiver's own surface before it, in depths
  Blockers blockers_in(const Kernel& kernel, double depth, double reach) const;
  Blockers moment_blockers(const SeenReceiver& seen, double kernel_width, double depth) const;
  double lit_share(const SeenReceiver& seen, double kernel_width, double depth,
                   double blocker) const;
  StepFix fix() const {
    return settings_.fix == cv::LitFix::scale ? StepFix::scale : StepFix::offset;
  }

  cv::AreaVisibilitySettings settings_;
  cv::ConvolutionSettings convolution_;
  ConvolutionSeries series_;
  DepthMap map_;
};

}  // namespace test_clustered_visibility
