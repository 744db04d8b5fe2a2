#pragma once

#include <memory>
#include <vector>

#include "renderers/clustered_visibility/area_visibility.h"
#include "renderers/clustered_visibility/convolution_maps.h"
#include "renderers/clustered_visibility/light_clusters.h"
#include "renderers/clustered_visibility/moment_maps.h"
#include "renderers/opengl/buffer.h"
#include "renderers/opengl/context.h"
#include "renderers/opengl/shader_source.h"
#include "renderers/shadow_maps/hemisphere_maps.h"
#include "tests/renderers/clustered_visibility/convolution_oracle.h"

/// Shadow maps of chosen distances on the device, and what convolution maps must make of them.
namespace test_clustered_visibility {

namespace cv = renderers::clustered_visibility;

/// Distances of some layers, m, row by row; infinity where there is nothing.
struct DepthLayers {
  int size_px = 0;
  std::vector<std::vector<float>> distances_m;
  std::vector<cv::AreaLight> area_lights;  ///< shape.y and position.w count

  int layers() const { return static_cast<int>(distances_m.size()); }
};

/// A slope with random blocks before it, a sixth of the texels without any surface, a few beyond
/// the range. Layers differ; no area light is empty.
DepthLayers blocks_on_slopes(int size_px, int layers);

class DepthBench {
 public:
  DepthBench(std::shared_ptr<renderers::opengl::Context> context, const DepthLayers& layers);

  void write(const DepthLayers& layers);
  cv::ConvolutionMaps convolution_maps(const cv::ConvolutionSettings& settings) const;
  cv::MomentMaps moment_maps() const;
  /// What a shader answers that writes one float to binding 4 (`results`) from the means of a whole
  /// map, as shaders/area_visibility.glsl reads them; `receiver_depth` is set.
  float answer(const cv::AreaVisibilitySettings& settings, const cv::AreaShadows& shadows,
               float receiver_depth, const renderers::opengl::ShaderFile& shader) const;
  const renderers::shadow_maps::HemisphereMaps& maps() const { return maps_; }
  const renderers::opengl::Buffer& area_lights() const { return area_lights_; }
  void make(cv::ConvolutionMaps& maps) const { maps.make(maps_, area_lights_); }

 private:
  std::shared_ptr<renderers::opengl::Context> context_;
  renderers::shadow_maps::HemisphereMaps maps_;
  renderers::opengl::Buffer area_lights_;
};

/// Depths of a layer in its units, within [0, 0.9], 0.9 where there is nothing.
DepthMap depths_of(const DepthLayers& layers, int layer);

enum class Quantity { sine, cosine, weighted_sine, weighted_cosine, depth };
inline constexpr Quantity kQuantities[]{Quantity::sine, Quantity::cosine, Quantity::weighted_sine,
                                        Quantity::weighted_cosine, Quantity::depth};
const renderers::opengl::Texture& texture_of(const cv::ConvolutionMaps& maps, Quantity quantity);
/// Of one texel. @param k  from 1
double value_of(Quantity quantity, int k, double z);
/// Means over squares of 2^level texels, row by row.
std::vector<double> level_means(const DepthMap& map, Quantity quantity, int k, int level);
/// Of a layer of the maps, as stored.
std::vector<double> read_level(const cv::ConvolutionMaps& maps, Quantity quantity, int k, int layer,
                               int level);

}  // namespace test_clustered_visibility
