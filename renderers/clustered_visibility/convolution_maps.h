#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "renderers/clustered_visibility/far_depth.h"
#include "renderers/opengl/buffer.h"
#include "renderers/opengl/program.h"
#include "renderers/opengl/texture.h"
#include "renderers/shadow_maps/hemisphere_maps.h"

namespace renderers::clustered_visibility {

enum class Prefilter {
  mip,  ///< trilinear in a chain of levels: square boxes of steps of two, interpolated
  sat   ///< summed-area tables: any box, in 32-bit fixed point
};

/// What the sines and cosines are stored as; those times depth are stored with 16 bits or more.
enum class BasisFormat { bits_8, bits_16, bits_32 };

struct ConvolutionSettings {
  int terms = 4;  ///< K, in [1, kMostTerms]
  Prefilter prefilter = Prefilter::mip;
  BasisFormat format = BasisFormat::bits_8;  ///< mip only
};

inline constexpr int kMostTerms = 16;

/// Layers of hemispherical shadow maps as a Fourier series of their depth comparison, filtered
/// ahead of it (Annen et al. 2007, 2008). The quantities per layer: sin(c_k z), cos(c_k z); the
/// same times z; z. Four terms to a texel, layers x ceil(K / 4) texture layers.
class ConvolutionMaps {
 public:
  /// @param size_px  a power of two, at least 4
  /// @throws UnsupportedError beyond the device's sizes or layers
  ConvolutionMaps(std::shared_ptr<opengl::Context> context, int size_px, int layers,
                  const ConvolutionSettings& settings);

  /// Makes all quantities from filled maps.
  /// @param area_lights  a layer's AreaLight (light_clusters.h); layers without lights are left out
  void make(const shadow_maps::HemisphereMaps& distances, const opengl::Buffer& area_lights);

  /// Sets the samplers that shaders/area_visibility.glsl declares.
  void bind(opengl::Program& program) const;

  const ConvolutionSettings& settings() const { return settings_; }
  /// Fixed-point steps per unit of the summed-area tables: 2^15, fewer from 256 x 256 texels.
  int table_scale() const;
  int levels() const { return step_.first.shape().levels; }
  const opengl::Texture& sines() const { return step_.first; }
  const opengl::Texture& cosines() const { return step_.second; }
  const opengl::Texture& weighted_sines() const { return weighted_.first; }
  const opengl::Texture& weighted_cosines() const { return weighted_.second; }
  const opengl::Texture& depths() const { return depth_.first; }
  /// Of the layers alone, without what is needed to make them.
  std::int64_t layer_bytes() const;
  std::int64_t memory_bytes() const;

 private:
  enum class Kind { step, weighted, depth };
  /// Two textures that are made together; `second` is empty for depth.
  struct Quantity {
    opengl::Texture first;
    opengl::Texture second;
  };

  int groups() const { return (settings_.terms + 3) / 4; }
  Quantity make_textures(Kind kind) const;
  opengl::Defines defines_of(Kind kind) const;
  void make_tables(Kind kind, const Quantity& quantity,
                   const shadow_maps::HemisphereMaps& distances, const opengl::Buffer& area_lights);

  std::shared_ptr<opengl::Context> context_;
  ConvolutionSettings settings_;
  int size_px_;
  int layers_;
  Quantity step_;
  Quantity weighted_;
  Quantity depth_;
  opengl::Buffer sums_;
};

}  // namespace renderers::clustered_visibility
